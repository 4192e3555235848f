// The minimum zone against closed forms, and against a search that knows nothing of it.
#include "tests/support/circularity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "acquisition/types/error.hpp"
#include "fixtures/synthetic/random.hpp"

namespace arris::bench {
namespace {

using Profile = std::vector<Eigen::Vector2d>;

Profile profile(int count, const Eigen::Vector2d& centre_mm, const std::function<double(double)>& radius_mm) {
  Profile points;
  for (int i = 0; i < count; ++i) {
    const double t = 2.0 * std::numbers::pi * i / count;
    points.emplace_back(centre_mm + radius_mm(t) * Eigen::Vector2d(std::cos(t), std::sin(t)));
  }
  return points;
}

double width_about(const Profile& points, const Eigen::Vector2d& centre_mm) {
  double low = 1e300, high = 0.0;
  for (const Eigen::Vector2d& p : points) {
    low = std::min(low, (p - centre_mm).norm());
    high = std::max(high, (p - centre_mm).norm());
  }
  return high - low;
}

TEST(MinimumZone, OfACircleIsNothingWhereverItLies) {
  const MinimumZone zone = minimum_zone(profile(360, {812.0, -77.0}, [](double) { return 150.0; }));
  EXPECT_NEAR(zone.width_mm(), 0.0, 1e-9);
  EXPECT_NEAR((zone.centre_mm - Eigen::Vector2d(812.0, -77.0)).norm(), 0.0, 1e-9);
}

TEST(MinimumZone, OfAnEllipseIsTheDifferenceOfItsHalfAxes) {
  const double a = 151.0, b = 149.5;
  const MinimumZone zone = minimum_zone(profile(
      720, {3.0, 4.0}, [&](double t) { return a * b / std::hypot(b * std::cos(t), a * std::sin(t)); }));
  EXPECT_NEAR(zone.outer_mm, a, 1e-9);
  EXPECT_NEAR(zone.inner_mm, b, 1e-9);
}

TEST(MinimumZone, OfLobesIsTwiceTheirHeight) {
  for (const int lobes : {2, 3, 5, 8}) {
    const MinimumZone zone =
        minimum_zone(profile(720, {-20.0, 9.0}, [&](double t) { return 100.0 + 0.4 * std::cos(lobes * t); }));
    EXPECT_NEAR(zone.width_mm(), 0.8, 1e-9) << lobes << " lobes";
  }
}

TEST(MinimumZone, OfARoundProfileWithOneDentIsNotTheMeanCirclesZone) {
  // The centre moves away from a dent: about the circle's own centre the zone would be the dent's depth.
  Profile points = profile(360, {0.0, 0.0}, [](double) { return 100.0; });
  points[0] *= 0.99;
  const MinimumZone zone = minimum_zone(points);
  EXPECT_LT(zone.width_mm(), 1.0 - 1e-6);
  EXPECT_LE(zone.width_mm(), width_about(points, {0.0, 0.0}));
}

TEST(MinimumZone, NoOtherCentreIsBetter) {
  synthetic::Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const Profile points = profile(90, {5.0, 5.0}, [&](double) { return 60.0 + 2.0 * random.uniform(); });
    const MinimumZone zone = minimum_zone(points);
    EXPECT_NEAR(zone.width_mm(), width_about(points, zone.centre_mm), 1e-12);
    for (int i = 0; i < 2000; ++i) {
      const double reach_mm = 2.0 * std::pow(10.0, -6.0 * random.uniform());
      const Eigen::Vector2d beside =
          zone.centre_mm + reach_mm * Eigen::Vector2d(random.uniform() - 0.5, random.uniform() - 0.5);
      EXPECT_GE(width_about(points, beside), zone.width_mm() - 1e-9);
    }
  }
}

TEST(MinimumZone, InSpaceIsThatOfThePlane) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  for (const Eigen::Vector2d& p :
       profile(360, {0.0, 0.0}, [](double t) { return 80.0 + 0.3 * std::cos(3.0 * t); }))
    points.emplace_back(turn * Eigen::Vector3d(p.x(), p.y(), 0.0) + Eigen::Vector3d(10.0, 20.0, 30.0));
  EXPECT_NEAR(circularity(points).width_mm(), 0.6, 1e-9);
}

TEST(MinimumZone, RefusesWhatDoesNotGoRound) {
  EXPECT_THROW((void)minimum_zone(Profile(3, Eigen::Vector2d::Zero())), Error);
}

}  // namespace
}  // namespace arris::bench
