#include "acquisition/thin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "acquisition/geometry/evenly_drawn.hpp"
#include "acquisition/geometry/nearest.hpp"
#include "fixtures/synthetic/random.hpp"

namespace arris {
namespace {

PointCloud square_cloud(int points) {
  PointCloud cloud;
  cloud.offset_mm = {1000.0, 0.0, 0.0};
  synthetic::Random random(1);
  for (int i = 0; i < points; ++i) {
    cloud.points_mm.emplace_back(static_cast<float>(random.uniform(0.0, 300.0)),
                                 static_cast<float>(random.uniform(0.0, 200.0)), 0.0F);
    cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
  }
  return cloud;
}

TEST(EvenlyDrawn, OneOfEachStretch) {
  for (const std::size_t size : {0U, 1U, 7U, 1000U, 123457U}) {
    const std::vector<std::size_t> chosen = evenly_drawn(size, 100);
    ASSERT_EQ(chosen.size(), std::min<std::size_t>(size, 100));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      EXPECT_GE(chosen[k], k * size / chosen.size());
      EXPECT_LT(chosen[k], (k + 1) * size / chosen.size());
    }
  }
}

TEST(EvenlyDrawn, RepeatsNoRow) {
  std::set<std::size_t> places;  // in rows of 100 points
  for (const std::size_t i : evenly_drawn(100000, 1000)) places.insert(i % 100);
  EXPECT_GT(places.size(), 90U);
}

TEST(ThinnedTo, KeepsMeasuredPointsAboutAsManyAsAsked) {
  const PointCloud cloud = square_cloud(60000);
  const PointCloud thin = thinned_to(cloud, 2000);
  EXPECT_NEAR(static_cast<double>(thin.size()), 2000.0, 400.0);
  EXPECT_EQ(thin.offset_mm, cloud.offset_mm);
  EXPECT_TRUE(thin.has_normals());
  const auto less = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::vector<Eigen::Vector3f> sorted = cloud.points_mm;
  std::sort(sorted.begin(), sorted.end(), less);
  for (const Eigen::Vector3f& p : thin.points_mm)
    EXPECT_TRUE(std::binary_search(sorted.begin(), sorted.end(), p, less)) << "never a mean";
}

TEST(ThinnedTo, LeavesNoHoles) {
  const PointCloud cloud = square_cloud(60000);
  const PointCloud thin = thinned_to(cloud, 2000);  // 30 mm^2 a point: a mean spacing of 5.5 mm
  const NearestPoints tree(local_points_mm(thin));
  for (std::size_t i = 0; i < cloud.size(); i += 7)
    EXPECT_LT(tree.nearest(cloud.local_mm(i)).distance2_mm2, 11.0 * 11.0);
}

TEST(ThinnedTo, LeavesASmallCloudAsItIs) {
  const PointCloud cloud = square_cloud(500);
  EXPECT_EQ(thinned_to(cloud, 500).points_mm, cloud.points_mm);
}

}  // namespace
}  // namespace arris
