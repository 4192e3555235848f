#include "toolpath/toolpath.hpp"

#include <gtest/gtest.h>

namespace arris {
namespace {

using Eigen::Vector3d;

// A square of side 10 as polyline 5, then a lone row as polyline 2.
ToolPath square_and_dot(bool closed) {
  ToolPath path;
  for (const Vector3d& tip_mm :
       {Vector3d(0, 0, 0), Vector3d(10, 0, 0), Vector3d(10, 10, 0), Vector3d(0, 10, 0)})
    path.points.push_back({tip_mm, Vector3d::UnitZ(), 5, 0.0, closed});
  path.points.push_back({Vector3d(50, 0, 0), Vector3d::UnitZ(), 2, 0.0, false});
  return path;
}

TEST(ToolPathRows, PolylinesAreRunsOfEqualNumbers) {
  const std::vector<PathRange> ranges = polylines(square_and_dot(true));
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].size(), 4u);
  EXPECT_TRUE(ranges[0].closed);
  EXPECT_EQ(ranges[1].begin, 4u);
  EXPECT_FALSE(ranges[1].closed);
  EXPECT_TRUE(polylines(ToolPath{}).empty());
}

TEST(ToolPathRows, ArcLengthBeginsAnewInEachPolyline) {
  EXPECT_EQ(arc_along_mm(square_and_dot(true)), (std::vector<double>{0.0, 10.0, 20.0, 30.0, 0.0}));
}

TEST(ToolPathRows, DirectionsLookBothWaysAndRoundTheSeam) {
  const double half = std::sqrt(0.5);
  const std::vector<Vector3d> closed = directions(square_and_dot(true));
  EXPECT_LT((closed[0] - Vector3d(half, -half, 0)).norm(), 1e-15);
  EXPECT_LT((closed[1] - Vector3d(half, half, 0)).norm(), 1e-15);
  EXPECT_EQ(closed[4], Vector3d::Zero());
  const std::vector<Vector3d> open = directions(square_and_dot(false));
  EXPECT_EQ(open[0], Vector3d::UnitX());
  EXPECT_EQ(open[3], Vector3d(-1, 0, 0));
}

}  // namespace
}  // namespace arris
