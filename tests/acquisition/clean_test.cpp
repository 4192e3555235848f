#include "acquisition/clean.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "acquisition/types/error.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

using testing::Random;

// A square grid, 1 mm a step, in the plane z = 0; `jitter_mm` moves the points in it.
PointCloud grid(int side, double jitter_mm, double noise_mm = 0.0) {
  Random random(1);
  PointCloud cloud;
  cloud.offset_mm = Eigen::Vector3d(1000.0, -2000.0, 3.0);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      cloud.points_mm.push_back(Eigen::Vector3d(i + random.uniform(-jitter_mm, jitter_mm),
                                                j + random.uniform(-jitter_mm, jitter_mm),
                                                noise_mm * random.normal())
                                    .cast<float>());
  return cloud;
}

void expect_is_a_selection(const Cleaned& cleaned, const PointCloud& from) {
  ASSERT_EQ(cleaned.kept.size(), cleaned.cloud.size());
  EXPECT_TRUE(std::is_sorted(cleaned.kept.begin(), cleaned.kept.end()));
  EXPECT_EQ(cleaned.cloud.offset_mm, from.offset_mm);
  for (std::size_t i = 0; i < cleaned.kept.size(); ++i) {
    const auto source = static_cast<std::size_t>(cleaned.kept[i]);
    EXPECT_EQ(cleaned.cloud.points_mm[i], from.points_mm[source]);
    if (!from.has_normals()) continue;
    EXPECT_EQ(cleaned.cloud.normals[i], from.normals[source]);
  }
  EXPECT_EQ(cleaned.kept.size() + cleaned.dropped_outliers + cleaned.dropped_by_voxel, from.size());
}

TEST(Clean, KeepsEveryPointOfARegularGridRimIncluded) {
  for (const double jitter_mm : {0.0, 0.2, 0.45}) {
    const PointCloud cloud = grid(60, jitter_mm, 0.02);
    const Cleaned cleaned = clean(cloud, {});
    EXPECT_EQ(cleaned.kept.size(), cloud.size()) << jitter_mm;
    expect_is_a_selection(cleaned, cloud);
  }
}

TEST(Clean, KeepsARegionThatIsFourTimesSparser) {
  PointCloud cloud = grid(60, 0.2);
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 15; ++j)
      cloud.points_mm.emplace_back(62.0F + 4.0F * static_cast<float>(i), 4.0F * static_cast<float>(j), 0.0F);
  const Cleaned cleaned = clean(cloud, {});
  EXPECT_LE(cleaned.dropped_outliers, 2U);
}

TEST(Clean, DropsStraysAlsoWhenOneIsAMetreAway) {
  PointCloud cloud = grid(60, 0.2, 0.02);
  const std::size_t good = cloud.size();
  Random random(2);
  for (int i = 0; i < 40; ++i)
    cloud.points_mm.push_back(
        Eigen::Vector3d(random.uniform(0, 60), random.uniform(0, 60), random.uniform(8.0, 40.0))
            .cast<float>());
  cloud.points_mm.emplace_back(0.0F, 0.0F, 1e3F);
  const Cleaned cleaned = clean(cloud, {});
  EXPECT_EQ(cleaned.dropped_outliers, 41U);
  ASSERT_FALSE(cleaned.kept.empty());
  EXPECT_LT(static_cast<std::size_t>(cleaned.kept.back()), good);
  expect_is_a_selection(cleaned, cloud);
}

TEST(Clean, IsSettledByOnePassOverACleanCloud) {
  PointCloud cloud = grid(50, 0.3, 0.02);
  cloud.points_mm.emplace_back(25.0F, 25.0F, 30.0F);
  const Cleaned once = clean(cloud, {.outlier_sigmas = 4.0, .voxel_mm = 2.5, .threads = 1});
  const Cleaned twice = clean(once.cloud, {.outlier_sigmas = 4.0, .voxel_mm = 2.5, .threads = 1});
  EXPECT_EQ(once.cloud.points_mm, twice.cloud.points_mm);
}

TEST(Clean, ZeroSigmasKeepsStrays) {
  PointCloud cloud = grid(20, 0.2);
  cloud.points_mm.emplace_back(0.0F, 0.0F, 100.0F);
  EXPECT_EQ(clean(cloud, {.outlier_sigmas = 0.0, .voxel_mm = 0.0, .threads = 1}).kept.size(), cloud.size());
}

TEST(Clean, LeavesOneMeasuredPointAVoxel) {
  Random random(3);
  PointCloud cloud;
  for (int i = 0; i < 5000; ++i) {
    cloud.points_mm.push_back(random.in_cube_mm(20.0).cast<float>());
    cloud.normals.push_back(random.direction().cast<float>());
  }
  const Cleaned cleaned = clean(cloud, {.outlier_sigmas = 0.0, .voxel_mm = 5.0, .threads = 1});
  expect_is_a_selection(cleaned, cloud);
  const auto cell_of = [](const Eigen::Vector3f& p_mm) {
    return std::array{std::floor(p_mm.x() / 5.0), std::floor(p_mm.y() / 5.0), std::floor(p_mm.z() / 5.0)};
  };
  std::set<std::array<double, 3>> before, after;
  for (const Eigen::Vector3f& p_mm : cloud.points_mm) before.insert(cell_of(p_mm));
  for (const Eigen::Vector3f& p_mm : cleaned.cloud.points_mm) after.insert(cell_of(p_mm));
  EXPECT_EQ(before, after);
  EXPECT_EQ(cleaned.cloud.size(), after.size());
}

TEST(Clean, DoesNotPullASphereInwards) {
  Random random(4);
  PointCloud cloud;
  for (int i = 0; i < 20000; ++i) cloud.points_mm.push_back((20.0 * random.direction()).cast<float>());
  const Cleaned cleaned = clean(cloud, {.outlier_sigmas = 0.0, .voxel_mm = 6.0, .threads = 1});
  EXPECT_LT(cleaned.cloud.size(), 400U);
  for (const Eigen::Vector3f& p_mm : cleaned.cloud.points_mm) EXPECT_NEAR(p_mm.norm(), 20.0, 1e-5);
}

TEST(Clean, GivesTheSameBytesForAnyThreadCount) {
  PointCloud cloud = grid(80, 0.4, 0.05);
  Random random(5);
  for (int i = 0; i < 100; ++i) cloud.points_mm.push_back(random.in_cube_mm(80.0).cast<float>());
  const Cleaned one = clean(cloud, {.outlier_sigmas = 3.0, .voxel_mm = 1.5, .threads = 1});
  EXPECT_GT(one.dropped_outliers, 0U);
  for (const int threads : {2, 8})
    EXPECT_EQ(clean(cloud, {.outlier_sigmas = 3.0, .voxel_mm = 1.5, .threads = threads}).kept, one.kept);
}

TEST(Clean, TakesCloudsThatAreTooSmallToJudge) {
  for (int side = 1; side < 4; ++side) {
    const PointCloud cloud = grid(side, 0.0);
    EXPECT_EQ(clean(cloud, {}).kept.size(), cloud.size());
  }
  PointCloud doubled;
  doubled.points_mm.assign(30, Eigen::Vector3f::Ones());
  EXPECT_EQ(clean(doubled, {}).kept.size(), 30U);
}

TEST(Clean, RefusesNothingAndNonsense) {
  const auto fault_of = [](const PointCloud& cloud, const CleanOptions& options) {
    try {
      (void)clean(cloud, options);
    } catch (const Error& error) {
      return error.fault();
    }
    return Fault::kBug;
  };
  EXPECT_EQ(fault_of({}, {}), Fault::kInput);
  EXPECT_EQ(fault_of(grid(4, 0.0), {.outlier_sigmas = -1.0, .voxel_mm = 0.0, .threads = 1}), Fault::kRecipe);
  EXPECT_EQ(fault_of(grid(4, 0.0), {.outlier_sigmas = 4.0, .voxel_mm = std::nan(""), .threads = 1}),
            Fault::kRecipe);
}

TEST(CropToBand, KeepsWhatIsNearInOrder) {
  const PointCloud cloud = grid(30, 0.2);
  const std::vector<Eigen::Vector3d> line_mm{{5.0, 5.0, 0.0}, {6.0, 5.0, 0.0}, {25.0, 20.0, 0.0}};
  const PointCloud band = crop_to_band(cloud, line_mm, 3.0);
  std::vector<Eigen::Vector3f> twin;
  for (const Eigen::Vector3f& p_mm : cloud.points_mm)
    if (std::any_of(line_mm.begin(), line_mm.end(),
                    [&](const Eigen::Vector3d& c_mm) { return (p_mm.cast<double>() - c_mm).norm() <= 3.0; }))
      twin.push_back(p_mm);
  EXPECT_EQ(band.points_mm, twin);
  EXPECT_EQ(band.offset_mm, cloud.offset_mm);
  EXPECT_TRUE(crop_to_band(cloud, {}, 3.0).empty());
  EXPECT_THROW((void)crop_to_band(cloud, line_mm, -1.0), Error);
}

}  // namespace
}  // namespace arris
