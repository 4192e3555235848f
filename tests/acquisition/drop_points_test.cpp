#include "acquisition/drop_points.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

Scan strip() {
  Scan scan;
  for (int i = 0; i < 6; ++i) {
    scan.cloud.points_mm.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    scan.cloud.normals.emplace_back(0.0F, static_cast<float>(i), 1.0F);
  }
  scan.triangles = {{0, 1, 2}, {1, 2, 3}, {3, 4, 5}};
  return scan;
}

TEST(DropPoints, KeepsTheOthersWithNormalsAndTheirTriangles) {
  const std::vector<std::int32_t> dropped = {0, 2};
  const ThinnedScan thinned = drop_points(strip(), dropped);
  EXPECT_EQ(thinned.kept, (std::vector<std::int32_t>{1, 3, 4, 5}));
  ASSERT_EQ(thinned.scan.cloud.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(thinned.scan.cloud.points_mm[i].x(), static_cast<float>(thinned.kept[i]));
    EXPECT_EQ(thinned.scan.cloud.normals[i].y(), static_cast<float>(thinned.kept[i]));
  }
  ASSERT_EQ(thinned.scan.triangles.size(), 1U);
  EXPECT_EQ(thinned.scan.triangles[0], (std::array<std::int32_t, 3>{1, 2, 3}));
}

TEST(DropPoints, OfNoneIsTheScan) {
  const ThinnedScan thinned = drop_points(strip(), {});
  EXPECT_EQ(thinned.scan.triangles, strip().triangles);
  EXPECT_EQ(thinned.scan.cloud.size(), 6U);
}

TEST(DropPoints, OutOfRangeIsABug) {
  const std::vector<std::int32_t> dropped = {6};
  EXPECT_THROW((void)drop_points(strip(), dropped), Error);
}

}  // namespace
}  // namespace arris
