#include "registration/subdivision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "acquisition/types/error.hpp"
#include "fixtures/synthetic/analytic_part.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;

Contour straight(double length_mm) {
  Contour line;
  for (int i = 0; i <= 200; ++i) line.points_mm.emplace_back(length_mm * i / 200.0, 0.0, 0.0);
  line.normals.assign(line.points_mm.size(), Eigen::Vector3d::UnitZ());
  return line;
}

/// A closed contour's points as an open chain.
Contour opened(Contour contour) {
  contour.closed = false;
  return contour;
}

std::vector<Contour> contours() {
  const PlatePart circle(synthetic::plate_with_circle()),
      rectangle(synthetic::plate_with_rounded_rectangle());
  return {circle.nominal_contour(0, 1.0), rectangle.nominal_contour(0, 1.0),
          opened(rectangle.nominal_contour(0, 1.0)), straight(300.0)};
}

SubdivisionOptions with(double epsilon_mm, double overlap_ratio) {
  SubdivisionOptions options;
  options.segment_length_max_mm = epsilon_mm;
  options.overlap_ratio = overlap_ratio;
  return options;
}

struct Case {
  Curve curve;
  double epsilon_mm, overlap_ratio;
  Subdivision subdivision;
};

/// Every contour with every epsilon and overlap, each named in the trace of a failure.
template <class Body>
void for_all_cases(const Body& body) {
  for (std::size_t c = 0; c < contours().size(); ++c)
    for (const double epsilon_mm : {25.0, 60.0, 120.0, 1000.0})
      for (const double overlap_ratio : {0.0, 0.1, 0.3, 0.5}) {
        SCOPED_TRACE(testing::Message()
                     << "contour " << c << ", epsilon " << epsilon_mm << ", overlap " << overlap_ratio);
        const Curve curve(contours()[c]);
        body({curve, epsilon_mm, overlap_ratio, Subdivision(curve, with(epsilon_mm, overlap_ratio))});
      }
}

void expect_partition(const Case& at, double s) {
  const std::vector<BlendWeight> blend = at.subdivision.weights(s);
  ASSERT_GE(blend.size(), 1u) << s;
  ASSERT_LE(blend.size(), 2u) << s;
  double sum = 0.0;
  for (const BlendWeight& entry : blend) {
    EXPECT_GE(entry.weight, 0.0) << s;
    sum += entry.weight;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12) << s;
}

TEST(Subdivision, WeightsArePositiveAndSumToOneWithAtMostTwoSegments) {
  for_all_cases([](const Case& at) {
    for (int i = 0; i < 2000; ++i) expect_partition(at, at.curve.length_mm() * i / 2000.0);
    for (const Segment& z : at.subdivision.segments())
      for (const double s : {z.begin_mm, z.end_mm, z.reach_begin_mm, z.reach_end_mm})
        expect_partition(at, at.curve.wrap_mm(s));
  });
}

/// All weights at one place, zeros included.
std::vector<double> all_weights(const Case& at, double s) {
  std::vector<double> out(at.subdivision.segments().size(), 0.0);
  for (const BlendWeight& entry : at.subdivision.weights(s))
    out[static_cast<std::size_t>(entry.segment)] = entry.weight;
  return out;
}

TEST(Subdivision, WeightsAreContinuousAlongTheContour) {
  for_all_cases([](const Case& at) {
    if (at.overlap_ratio == 0.0) return;  // the pieces meet with a step by choice
    const std::vector<Segment>& segments = at.subdivision.segments();
    double narrowest_mm = 1e300;
    for (std::size_t z = 0; z < segments.size(); ++z)
      if (at.curve.closed() || z + 1 < segments.size())
        narrowest_mm = std::min(narrowest_mm, 2.0 * (segments[z].reach_end_mm - segments[z].end_mm));
    // sin^2 over a width w climbs by at most pi / (2 w) a millimetre.
    const int count = 4000;
    const double step_mm = at.curve.length_mm() / count;
    const double most = 0.5 * std::numbers::pi / narrowest_mm * step_mm + 1e-9;
    std::vector<double> last = all_weights(at, 0.0);
    for (int i = 1; i <= count; ++i) {
      const double s = i == count && at.curve.closed() ? 0.0 : std::min(at.curve.length_mm(), i * step_mm);
      const std::vector<double> now = all_weights(at, s);
      for (std::size_t z = 0; z < now.size(); ++z) ASSERT_LE(std::abs(now[z] - last[z]), most) << s;
      last = now;
    }
  });
}

TEST(Subdivision, CoresCoverTheContourOnceAndNoneIsLongerThanEpsilon) {
  for_all_cases([](const Case& at) {
    double total_mm = 0.0;
    const std::vector<Segment>& segments = at.subdivision.segments();
    for (std::size_t z = 0; z < segments.size(); ++z) {
      const Segment& own = segments[z];
      total_mm += own.end_mm - own.begin_mm;
      EXPECT_GT(own.end_mm, own.begin_mm);
      EXPECT_LE(own.end_mm - own.begin_mm, at.epsilon_mm + 1e-9);
      if (z + 1 < segments.size()) {
        EXPECT_NEAR(segments[z + 1].begin_mm, own.end_mm, 1e-9);
      }
    }
    EXPECT_NEAR(total_mm, at.curve.length_mm(), 1e-9);
  });
}

TEST(Subdivision, CutsOutCornersThatBendTighterThanRhoAndLeavesStraightRunsWhole) {
  const PlatePart part(synthetic::plate_with_rounded_rectangle());  // 180 x 110 mm, corners of radius 20
  const Curve curve(part.nominal_contour(0, 1.0));
  SubdivisionOptions options = with(200.0, 0.0);  // a tenth of it is the shortest piece: below the corners
  options.corner_radius_max_mm = 40.0;
  const std::vector<Segment> cut = Subdivision(curve, options).segments();
  EXPECT_EQ(cut.size(), 8u);
  // The sides are 140 and 70 mm, the quarter circles 31.4 mm; the radius is fitted over +-8 mm.
  const double flats_mm[] = {140.0, 70.0, 140.0, 70.0}, quarter_mm = 10.0 * std::numbers::pi;
  double s = 0.0;
  const Subdivision subdivision(curve, options);
  for (const double flat_mm : flats_mm) {
    const std::vector<BlendWeight> side = subdivision.weights(s + 0.5 * flat_mm);
    const std::vector<BlendWeight> corner = subdivision.weights(s + flat_mm + 0.5 * quarter_mm);
    ASSERT_EQ(side.size(), 1u);
    ASSERT_EQ(corner.size(), 1u);
    const auto length_mm = [&](int z) {
      return cut[static_cast<std::size_t>(z)].end_mm - cut[static_cast<std::size_t>(z)].begin_mm;
    };
    EXPECT_NEAR(length_mm(corner.front().segment), quarter_mm, 16.0);
    EXPECT_NEAR(length_mm(side.front().segment), flat_mm, 16.0);
    s += flat_mm + quarter_mm;
  }
  options.corner_radius_max_mm = 15.0;  // below the corners' radius: nothing is a corner
  EXPECT_EQ(Subdivision(curve, options).segments().size(), 3u);
}

TEST(Subdivision, CircleIsAllCornerOrNone) {
  const Curve curve(PlatePart(synthetic::plate_with_circle(60.0)).nominal_contour(0, 1.0));
  for (const double rho_mm : {40.0, 80.0}) {
    SubdivisionOptions options = with(100.0, 0.3);
    options.corner_radius_max_mm = rho_mm;
    EXPECT_EQ(Subdivision(curve, options).segments().size(), 4u);  // ceil(377 / 100)
  }
}

TEST(Subdivision, LongPieceGetsTheFewestEquallySpacedCuts) {
  for (const auto& [length_mm, epsilon_mm, pieces] :
       {std::tuple{100.0, 30.0, 4}, {90.0, 30.0, 3}, {90.1, 30.0, 4}, {29.0, 30.0, 1}, {30.0, 30.0, 1}}) {
    const std::vector<Segment> segments =
        Subdivision(Curve(straight(length_mm)), with(epsilon_mm, 0.3)).segments();
    ASSERT_EQ(static_cast<int>(segments.size()), pieces) << length_mm;
    for (const Segment& z : segments) EXPECT_NEAR(z.end_mm - z.begin_mm, length_mm / pieces, 1e-9);
    EXPECT_EQ(segments.front().reach_begin_mm, 0.0);
    EXPECT_EQ(segments.back().reach_end_mm, length_mm);
  }
}

TEST(Subdivision, PrintedWeightTearsAConstantFieldApart) {
  // Two neighbours that both moved by 10 mm: the blend must say 10 mm all through their overlap.
  const double shift_mm = 10.0, printed_mm[] = {-5.0, 20.0, -5.0};
  const Subdivision subdivision(Curve(straight(200.0)), with(100.0, 0.5));
  const Segment& first = subdivision.segments()[0];
  const Segment& second = subdivision.segments()[1];
  const double width_mm = first.reach_end_mm - second.reach_begin_mm;
  ASSERT_NEAR(width_mm, 50.0, 1e-9);
  for (int quarter = 1; quarter <= 3; ++quarter) {
    const double s = second.reach_begin_mm + 0.25 * quarter * width_mm;
    const double own_mm = s - second.reach_begin_mm, next_mm = first.reach_end_mm - s;
    const double sum = printed_eq8(own_mm, next_mm) + printed_eq8(next_mm, own_mm);
    EXPECT_NEAR(sum * shift_mm, printed_mm[quarter - 1], 1e-9);
    const std::vector<BlendWeight> blend = subdivision.weights(s);
    ASSERT_EQ(blend.size(), 2u);
    EXPECT_NEAR((blend[0].weight + blend[1].weight) * shift_mm, shift_mm, 1e-12);
    const double sine = std::sin(0.125 * std::numbers::pi * quarter);
    EXPECT_NEAR(blend[1].weight, sine * sine, 1e-9);
  }
}

TEST(Subdivision, RefusesOptionsOutOfRange) {
  const Curve curve(straight(100.0));
  EXPECT_THROW(Subdivision(curve, with(100.0, 0.51)), Error);
  EXPECT_THROW(Subdivision(curve, with(100.0, -0.01)), Error);
  EXPECT_THROW(Subdivision(curve, with(0.5, 0.3)), Error);
  try {
    Subdivision(curve, with(100.0, 0.6));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("overlap"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("0 to 0.5"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace arris
