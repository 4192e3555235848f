#include "acquisition/geometry/curve_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "tests/geometry/random_points.hpp"

namespace arris {
namespace {

std::vector<Eigen::Vector3f> points_in_cube(int count, unsigned seed) {
  testing::Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) points.push_back(random.in_cube_mm(100.0).cast<float>());
  return points;
}

TEST(CurveOrder, NamesEachPointOnce) {
  for (const int count : {0, 1, 2, 1000, 40000, 200000}) {
    std::vector<Eigen::Vector3f> points = points_in_cube(count, 1);
    if (count > 2) points[1].setConstant(std::numeric_limits<float>::quiet_NaN());
    std::vector<std::uint32_t> order = curve_order(points, 2);
    if (count > 2) {
      EXPECT_EQ(order.front(), 1U) << "what is not finite comes first";
    }
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(order, all);
  }
}

TEST(CurveOrder, StepsFromCellToNextCell) {
  constexpr int kSide = 16;  // a full grid: a Hilbert curve never jumps
  std::vector<Eigen::Vector3f> grid;
  for (int i = 0; i < kSide * kSide * kSide; ++i)
    grid.emplace_back(static_cast<float>(i % kSide), static_cast<float>(i / kSide % kSide),
                      static_cast<float>(i / kSide / kSide));
  const std::vector<std::uint32_t> order = curve_order(grid, 1);
  for (std::size_t i = 1; i < order.size(); ++i)
    EXPECT_FLOAT_EQ((grid[order[i]] - grid[order[i - 1]]).norm(), 1.0F) << i;
}

TEST(CurveOrder, PointsInOnePlaceKeepTheirOrder) {
  const std::vector<Eigen::Vector3f> points(50, Eigen::Vector3f(3, 4, 5));
  const std::vector<std::uint32_t> order = curve_order(points, 1);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(CurveOrder, ManyPointsAreOrderedAsFewOfThem) {
  // The place on the curve depends on the box alone: a part of the points with the same box keeps its order.
  std::vector<Eigen::Vector3f> few = points_in_cube(20000, 3);
  few.emplace_back(-100.0F, -100.0F, -100.0F);
  few.emplace_back(100.0F, 100.0F, 100.0F);
  std::vector<Eigen::Vector3f> many = few;
  for (const Eigen::Vector3f& p : points_in_cube(150000, 4)) many.push_back(p);
  std::vector<std::uint32_t> those_of_few;
  for (const std::uint32_t i : curve_order(many, 2))
    if (i < few.size()) those_of_few.push_back(i);
  EXPECT_EQ(those_of_few, curve_order(few, 1));
}

TEST(CurveOrder, SameForAnyThreadCount) {
  const std::vector<Eigen::Vector3f> points = points_in_cube(100000, 2);
  EXPECT_EQ(curve_order(points, 1), curve_order(points, 2));
  EXPECT_EQ(curve_order(points, 1), curve_order(points, 8));
}

}  // namespace
}  // namespace arris
