#include "registration/judge.hpp"

#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// A contour of 600 mm in bins of 10 mm, all of it seen but where a test takes some away.
class Gaps : public testing::Test {
 protected:
  static synthetic::PlateShape shape() { return synthetic::plate_with_circle(600.0 / 6.283185307179586); }

  void SetUp() override {
    const Curve& curve = cad_.contours.front();
    EdgeFit edge(ArcSpline(curve.length_mm(), true, 40.0));
    edge.bin_mm = curve.length_mm() / 60.0;
    edge.density_per_mm2 = 0.25;
    edge.seen.assign(60, 1);
    edge.beside.assign(60, 1);
    edge.row_gap_mm.assign(60, 0.0);
    found_.contours.push_back({scenes::rigid_along(curve, RigidMotion::Identity()), std::move(edge)});
    options_.min_seen_ratio = 0.0;
  }
  EdgeFit& edge() { return found_.contours.front().edge; }
  void hide_edge(std::size_t from, std::size_t bins) {
    for (std::size_t k = 0; k < bins; ++k) edge().seen[(from + k) % 60] = 0;
  }
  void hide_all(std::size_t from, std::size_t bins) {
    hide_edge(from, bins);
    for (std::size_t k = 0; k < bins; ++k) edge().beside[(from + k) % 60] = 0;
  }
  [[nodiscard]] std::vector<std::string> refusals() {
    found_.refusals.clear();
    judge_coverage(cad_, options_, found_);
    return found_.refusals;
  }

  synthetic::PlatePart part_{shape()};
  CadModel cad_ = scenes::cad_of(part_);
  RegistrationOptions options_;
  Registration found_;
};

TEST_F(Gaps, SurfaceFieldCarriesOneUpToTheLimit) {
  EXPECT_TRUE(refusals().empty());
  hide_all(5, 19);
  EXPECT_TRUE(refusals().empty());
  hide_all(5, 21);
  ASSERT_EQ(refusals().size(), 1U);
  EXPECT_NE(refusals()[0].find("not seen from s = 50 to 260 mm (210 mm, at most 200)"), std::string::npos)
      << refusals()[0];
}

TEST_F(Gaps, WithTheSurfaceBesideItItMayBeHalfAsLongAgain) {
  hide_edge(5, 29);
  EXPECT_TRUE(refusals().empty());
  hide_edge(5, 31);
  ASSERT_EQ(refusals().size(), 1U);
  EXPECT_NE(refusals()[0].find("at most 300): only the surface beside it"), std::string::npos)
      << refusals()[0];
}

TEST_F(Gaps, TheStretchWithoutSurfaceCountsByItself) {
  hide_edge(0, 29);
  hide_all(4, 21);
  ASSERT_EQ(refusals().size(), 1U);
  EXPECT_NE(refusals()[0].find("(210 mm, at most 200)"), std::string::npos) << refusals()[0];
}

TEST_F(Gaps, GapOverTheStartOfTheContourIsOne) {
  hide_all(50, 21);
  ASSERT_EQ(refusals().size(), 1U);
  EXPECT_NE(refusals()[0].find("(210 mm, at most 200)"), std::string::npos) << refusals()[0];
}

TEST_F(Gaps, OtherMethodsGetNothingForTheSurfaceBeside) {
  options_.method = RegistrationMethod::kSubdivision;
  options_.max_unseen_mm = kUnseenMm;
  hide_edge(5, 9);
  EXPECT_TRUE(refusals().empty());
  hide_edge(5, 11);
  EXPECT_EQ(refusals().size(), 1U);
}

TEST_F(Gaps, OtherMethodsTakeRowsAlongTheEdgeForOne) {
  options_.method = RegistrationMethod::kSubdivision;
  options_.max_unseen_mm = kUnseenMm;
  for (std::size_t bin = 10; bin < 21; ++bin) edge().row_gap_mm[bin] = 12.0;
  ASSERT_EQ(refusals().size(), 1U);
  EXPECT_NE(refusals()[0].find("rows of points 12.0 mm apart"), std::string::npos) << refusals()[0];
  options_.method = RegistrationMethod::kSurface;
  EXPECT_TRUE(refusals().empty());
}

}  // namespace
}  // namespace arris
