#include "registration/face_match.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "registration/coarse_align.hpp"
#include "registration/edge_grid.hpp"
#include "registration/pose_score.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

constexpr double kCapMm = 6.0;

std::vector<EdgePlace> random_edges(synthetic::Random& random) {
  std::vector<EdgePlace> edges;
  for (int i = 0; i < 40; ++i)
    edges.push_back({{random.uniform(-80.0, 120.0), random.uniform(10.0, 90.0)}, random.uniform(-9.0, 9.0)});
  return edges;
}

TEST(EdgeGrid, HoldsTheDistanceToTheNearestEdgeOfTheSameSide) {
  synthetic::Random random(1);
  const std::vector<EdgePlace> edges = random_edges(random);
  const EdgeGrid grid(edges, kCapMm);
  for (int i = 0; i < 3000; ++i) {
    const int sector = static_cast<int>(random.index(EdgeGrid::kSectors));
    const int x = static_cast<int>(random.uniform(-9.0, 110.0)),
              y = static_cast<int>(random.uniform(-9.0, 50.0));
    const Eigen::Vector2d middle_mm = grid.low_mm() + grid.step_mm() * Eigen::Vector2d(x + 0.5, y + 0.5);
    double least2 = kCapMm * kCapMm;
    for (const EdgePlace& edge : edges) {
      const int apart = (EdgeGrid::sector_of(edge.inward_rad) - sector) & (EdgeGrid::kSectors - 1);
      if (apart <= 1 || apart == EdgeGrid::kSectors - 1)
        least2 = std::min(least2, (edge.place_mm - middle_mm).squaredNorm());
    }
    EXPECT_NEAR(grid.least2(sector, 0, x, y), least2, 1e-4) << x << " " << y;
  }
}

TEST(EdgeGrid, ALevelHoldsTheLeastOfItsCells) {
  synthetic::Random random(2);
  const EdgeGrid grid(random_edges(random), kCapMm);
  for (int level = 1; level < EdgeGrid::kLevels; ++level)
    for (int i = 0; i < 200; ++i) {
      const int sector = static_cast<int>(random.index(EdgeGrid::kSectors));
      const int x = static_cast<int>(random.uniform(-40.0, 120.0)),
                y = static_cast<int>(random.uniform(-40.0, 60.0));
      float least2 = 1e30F;
      for (int j = y; j < y + (1 << level); ++j)
        for (int k = x; k < x + (1 << level); ++k) least2 = std::min(least2, grid.least2(sector, 0, k, j));
      EXPECT_LE(grid.least2(sector, level, x, y), least2) << level << ": " << x << " " << y;
      if (x < -3 || y < -3) continue;  // where what lies below the grid counts as its border
      EXPECT_EQ(grid.least2(sector, level, x, y), least2) << level << ": " << x << " " << y;
    }
}

/// Chains of a few points each, in any order: no loop is left to match.
std::vector<Contour> in_crumbs(const std::vector<Contour>& loops) {
  constexpr std::size_t kLong = 6;
  std::vector<Contour> crumbs;
  for (const Contour& loop : loops)
    for (std::size_t first = 0; first + kLong < loop.points_mm.size(); first += kLong) {
      Contour crumb;
      for (std::size_t i = first; i < first + kLong; ++i) {
        crumb.points_mm.push_back(loop.points_mm[i]);
        crumb.normals.push_back(loop.normals[i]);
      }
      crumbs.push_back(crumb);
    }
  std::reverse(crumbs.begin(), crumbs.end());
  return crumbs;
}

class FaceMatchOfSixHoles : public testing::Test {
 protected:
  synthetic::PlatePart part_{synthetic::plate_with_six_holes()};
  CadModel cad_ = scenes::cad_of(part_);
  double cap_mm_ = PoseScore(cad_, 60.0).cap_mm();

  static synthetic::ScanOptions on_a_table() {
    synthetic::ScanOptions options;
    options.band_mm = 0.0;
    options.around.table_below_mm = 30.0;
    return options;
  }
  /// Of the followed contour.
  [[nodiscard]] double off_mm(const RigidMotion& a, const RigidMotion& b) const {
    double most = 0.0;
    for (const Eigen::Vector3d& p : cad_.contours[0].contour().points_mm)
      most = std::max(most, (a * p - b * p).norm());
    return most;
  }
};

TEST_F(FaceMatchOfSixHoles, LaysTheContoursOnEdgesThatMakeNoLoop) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    scenes::Trial trial = scenes::trial_of(part_, on_a_table(), seed);
    trial.scan.loops = in_crumbs(trial.scan.loops);
    const std::vector<RigidMotion> starts =
        match_faces(cad_, LightScan(trial.scan, false, false).model, cap_mm_, 4, 1);
    ASSERT_FALSE(starts.empty());
    double least_mm = 1e300;
    for (const RigidMotion& start : starts) least_mm = std::min(least_mm, off_mm(start, trial.scan_from_cad));
    EXPECT_LT(least_mm, 2.0 * cap_mm_) << seed;
    if (seed > 1) continue;
    const CoarseAlignment found = coarse_align(cad_, trial.scan, {});
    ASSERT_TRUE(found.usable()) << found.reason;
    EXPECT_EQ(found.start, "matching the edges of faces");
    EXPECT_LT(off_mm(found.scan_from_cad, trial.scan_from_cad), trial.scan.spacing_mm) << seed;
  }
}

TEST_F(FaceMatchOfSixHoles, SameStartsForAnyThreadCountAndNoneFromRejectedLoops) {
  scenes::Trial trial = scenes::trial_of(part_, on_a_table(), 4);
  const std::vector<RigidMotion> one = match_faces(cad_, trial.scan, cap_mm_, 4, 1);
  const std::vector<RigidMotion> eight = match_faces(cad_, trial.scan, cap_mm_, 4, 8);
  ASSERT_EQ(one.size(), eight.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].matrix(), eight[i].matrix());
  trial.scan.loop_rejected.assign(trial.scan.loops.size(), 1);
  EXPECT_TRUE(match_faces(cad_, trial.scan, cap_mm_, 4, 1).empty());
}

TEST_F(FaceMatchOfSixHoles, OfManyContoursSomePlacesDo) {
  const scenes::Trial trial = scenes::trial_of(part_, on_a_table(), 6);
  CadModel many = cad_;
  many.contours.assign(1000, cad_.contours[0]);
  const std::vector<RigidMotion> starts = match_faces(many, trial.scan, cap_mm_, 4, 1);
  ASSERT_FALSE(starts.empty());
  EXPECT_LT(off_mm(starts.front(), trial.scan_from_cad), 2.0 * cap_mm_);
}

TEST_F(FaceMatchOfSixHoles, ContoursRoundATubeLieInNoPlane) {
  const scenes::Trial trial = scenes::trial_of(part_, on_a_table(), 5);
  Contour round;
  round.closed = true;
  for (int i = 0; i < 100; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / 100.0;
    round.normals.emplace_back(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    round.points_mm.push_back(50.0 * round.normals.back());
  }
  CadModel tube = cad_;
  tube.contours = {Curve(round)};
  tube.others.clear();
  EXPECT_TRUE(match_faces(tube, trial.scan, cap_mm_, 4, 1).empty());
}

}  // namespace
}  // namespace arris
