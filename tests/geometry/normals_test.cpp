#include "acquisition/geometry/normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "acquisition/types/error.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using testing::Random;
using Points = std::vector<Eigen::Vector3d>;

// A sheet 1 mm a step, tilted, at an offset; noise along its normal.
const Eigen::Vector3d kTilted = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();

Points sheet_mm(int side, double noise_mm, unsigned seed) {
  Random random(seed);
  const Eigen::Vector3d u = kTilted.unitOrthogonal();
  const Eigen::Vector3d v = kTilted.cross(u);
  Points points_mm;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      points_mm.push_back(Eigen::Vector3d(2000.0, -300.0, 40.0) + (i + random.uniform(-0.4, 0.4)) * u +
                          (j + random.uniform(-0.4, 0.4)) * v + noise_mm * random.normal() * kTilted);
  return points_mm;
}

TEST(LocalPlanes, FindTheNormalOfACleanSheet) {
  const Points points_mm = sheet_mm(30, 0.0, 1);
  const LocalPlanes planes = fit_local_planes(points_mm, NearestPoints(points_mm), 10, 1);
  for (const Eigen::Vector3d& normal : planes.normals) {
    EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
    EXPECT_LT(normal.cross(kTilted).norm(), 1e-9);
  }
  EXPECT_LT(planes.noise_sigma_mm, 1e-9);
}

TEST(LocalPlanes, MeasureTheNoiseWhateverTheNeighbourhood) {
  for (const double noise_mm : {0.01, 0.05})
    for (const int k : {6, 10, 20, 40}) {
      const Points points_mm = sheet_mm(100, noise_mm, 2);
      const LocalPlanes planes = fit_local_planes(points_mm, NearestPoints(points_mm), k, 1);
      EXPECT_NEAR(planes.noise_sigma_mm / noise_mm, 1.0, 0.05) << "k = " << k;
    }
}

TEST(LocalPlanes, NoiseIgnoresOneStrayInAHundred) {
  Points points_mm = sheet_mm(100, 0.02, 3);
  Random random(4);
  for (std::size_t i = 0; i < points_mm.size(); i += 100) points_mm[i] += random.uniform(1.0, 5.0) * kTilted;
  const LocalPlanes planes = fit_local_planes(points_mm, NearestPoints(points_mm), 8, 1);
  EXPECT_NEAR(planes.noise_sigma_mm, 0.02, 0.006);
}

TEST(LocalPlanes, SpacingIsTheSideOfASquareGrid) {
  const Points points_mm = sheet_mm(100, 0.0, 5);
  const LocalPlanes planes = fit_local_planes(points_mm, NearestPoints(points_mm), 12, 1);
  EXPECT_NEAR(planes.spacing_median_mm, 1.0, 0.06);
  Points twice_mm = points_mm;
  for (Eigen::Vector3d& p_mm : twice_mm) p_mm *= 2.0;
  const LocalPlanes scaled = fit_local_planes(twice_mm, NearestPoints(twice_mm), 12, 1);
  EXPECT_NEAR(scaled.spacing_median_mm, 2.0 * planes.spacing_median_mm, 1e-9);
}

TEST(LocalPlanes, GiveTheSameBytesForAnyThreadCount) {
  const Points points_mm = sheet_mm(120, 0.03, 6);
  const NearestPoints tree(points_mm);
  const LocalPlanes one = fit_local_planes(points_mm, tree, 10, 1);
  for (const int threads : {2, 8}) {
    const LocalPlanes many = fit_local_planes(points_mm, tree, 10, threads);
    EXPECT_EQ(
        std::memcmp(one.normals.data(), many.normals.data(), one.normals.size() * sizeof(Eigen::Vector3d)),
        0);
    EXPECT_EQ(one.spacing_mm, many.spacing_mm);
    EXPECT_EQ(one.noise_sigma_mm, many.noise_sigma_mm);
    EXPECT_EQ(one.spacing_median_mm, many.spacing_median_mm);
  }
}

TEST(LocalPlanes, NormalsPointAlongTheRadiusOfASphere) {
  Points points_mm;
  for (int i = 0; i < 20000; ++i) {  // Fibonacci lattice
    const double z = 1.0 - (2.0 * i + 1.0) / 20000.0;
    const double turn_rad = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    points_mm.push_back(50.0 * Eigen::Vector3d(r * std::cos(turn_rad), r * std::sin(turn_rad), z));
  }
  LocalPlanes planes = fit_local_planes(points_mm, NearestPoints(points_mm), 10, 1);
  orient_towards(points_mm, Eigen::Vector3d::Zero(), planes.normals);
  for (std::size_t i = 0; i < points_mm.size(); ++i)
    EXPECT_LT((planes.normals[i] + points_mm[i].normalized()).norm(), 0.02);
}

TEST(LocalPlanes, SurviveCloudsThatAreTooSmallOrDoubled) {
  for (std::size_t count = 0; count < 4; ++count) {
    Points few_mm = sheet_mm(2, 0.0, 7);
    few_mm.resize(count);
    const LocalPlanes planes = fit_local_planes(few_mm, NearestPoints(few_mm), 5, 1);
    EXPECT_EQ(planes.normals.size(), count);
    for (const Eigen::Vector3d& normal : planes.normals) EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
  }
  const Points same_mm(30, Eigen::Vector3d(1.0, 2.0, 3.0));
  const LocalPlanes planes = fit_local_planes(same_mm, NearestPoints(same_mm), 5, 1);
  for (const Eigen::Vector3d& normal : planes.normals) EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
  EXPECT_EQ(planes.spacing_median_mm, 0.0);
}

TEST(LocalPlanes, ThrowOnBrokenPromises) {
  const Points points_mm = sheet_mm(4, 0.0, 8);
  const NearestPoints tree(points_mm);
  std::vector<Eigen::Vector3d> normals(3);
  EXPECT_THROW((void)fit_local_planes(points_mm, tree, 2, 1), Error);
  EXPECT_THROW((void)fit_local_planes(std::span(points_mm).first(3), tree, 5, 1), Error);
  EXPECT_THROW(orient_towards(points_mm, Eigen::Vector3d::Zero(), normals), Error);
}

}  // namespace
}  // namespace arris
