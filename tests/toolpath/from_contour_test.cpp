#include "toolpath/from_contour.hpp"

#include <gtest/gtest.h>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kTwoPi = 6.283185307179586;

// A circle in the plane z = 0, normal +z. As an outline its material is inside, as a hole outside.
Contour circle(double radius_mm, bool hole, int points = 720) {
  Contour contour;
  contour.id = 4;
  contour.closed = true;
  for (int i = 0; i < points; ++i) {
    const double angle = (hole ? -1.0 : 1.0) * kTwoPi * i / points;  // material on the left
    contour.points_mm.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0.0);
    contour.normals.emplace_back(0.0, 0.0, 1.0);
  }
  return contour;
}

// A rectangle with sharp corners, 80 x 40 mm about the origin.
Contour rectangle(bool hole) {
  Contour contour;
  contour.id = 2;
  contour.closed = true;
  contour.points_mm = {{-40, -20, 0}, {40, -20, 0}, {40, 20, 0}, {-40, 20, 0}};
  if (hole) std::reverse(contour.points_mm.begin(), contour.points_mm.end());
  contour.normals.assign(4, Vector3d::UnitZ());
  return contour;
}

ToolPath laid(const Contour& contour, const FromContourOptions& options) {
  return path_from_contours(std::span<const Contour>(&contour, 1), options);
}

TEST(FromContour, WithoutOptionsItIsTheContour) {
  const ToolPath path = laid(circle(50.0, true), {});
  EXPECT_EQ(path.source, "from contour 4");
  for (const PathPoint& row : path.points) {
    EXPECT_NEAR(row.tip_mm.norm(), 50.0, 0.02);
    EXPECT_EQ(row.axis, Vector3d(0.0, 0.0, 1.0));
    EXPECT_TRUE(row.closed);
  }
  ASSERT_EQ(polylines(path).size(), 1u);
  for (std::size_t i = 1; i < path.points.size(); ++i)
    EXPECT_LE((path.points[i].tip_mm - path.points[i - 1].tip_mm).norm(), 2.0 + 1e-9);
}

TEST(FromContour, PositiveOffsetGoesTowardsTheVoidOfHolesAndOfOutlines) {
  FromContourOptions options;
  options.offset_mm = 3.0;
  options.depth_mm = 1.5;
  for (const PathPoint& row : laid(circle(50.0, true), options).points) {
    EXPECT_NEAR(row.tip_mm.head<2>().norm(), 47.0, 0.03);
    EXPECT_EQ(row.tip_mm.z(), -1.5);
  }
  for (const PathPoint& row : laid(circle(50.0, false), options).points)
    EXPECT_NEAR(row.tip_mm.head<2>().norm(), 53.0, 0.03);
  options.offset_mm = -3.0;
  for (const PathPoint& row : laid(circle(50.0, true), options).points)
    EXPECT_NEAR(row.tip_mm.head<2>().norm(), 53.0, 0.03);
}

TEST(FromContour, OuterCornersAreRoundedAtTheOffset) {
  FromContourOptions options;
  options.offset_mm = 5.0;
  const Contour outline = rectangle(false);
  const ToolPath path = laid(outline, options);
  const Curve curve(outline);
  double longest_mm = 0.0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    EXPECT_NEAR(curve.nearest(path.points[i].tip_mm).distance_mm, 5.0, 1e-9);
    const Vector3d& next_mm = path.points[(i + 1) % path.points.size()].tip_mm;
    longest_mm = std::max(longest_mm, (next_mm - path.points[i].tip_mm).norm());
  }
  EXPECT_LE(longest_mm, 2.0 + 1e-9);
}

TEST(FromContour, InnerCornersMeetInAPointAndLeaveNoLoops) {
  FromContourOptions options;
  options.offset_mm = 5.0;
  const ToolPath path = laid(rectangle(true), options);
  int corners = 0;
  double length_mm_ = 0.0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const Vector3d& tip_mm = path.points[i].tip_mm;
    EXPECT_LE(std::abs(tip_mm.x()), 35.0 + 1e-9);
    EXPECT_LE(std::abs(tip_mm.y()), 15.0 + 1e-9);
    EXPECT_TRUE(std::abs(std::abs(tip_mm.x()) - 35.0) < 1e-9 || std::abs(std::abs(tip_mm.y()) - 15.0) < 1e-9);
    corners +=
        std::abs(std::abs(tip_mm.x()) - 35.0) < 1e-9 && std::abs(std::abs(tip_mm.y()) - 15.0) < 1e-9 ? 1 : 0;
    length_mm_ += (path.points[(i + 1) % path.points.size()].tip_mm - tip_mm).norm();
  }
  EXPECT_EQ(corners, 4);
  EXPECT_NEAR(length_mm_, 2.0 * (70.0 + 30.0), 1e-9);
}

TEST(FromContour, CornersOfTheContourAreRows) {
  const ToolPath path = laid(rectangle(false), {});
  for (const Vector3d& corner_mm : rectangle(false).points_mm) {
    double nearest_mm = 1e9;
    for (const PathPoint& row : path.points)
      nearest_mm = std::min(nearest_mm, (row.tip_mm - corner_mm).norm());
    EXPECT_LT(nearest_mm, 1e-12);
  }
}

TEST(FromContour, AnOffsetWithoutRoomIsRefused) {
  FromContourOptions options;
  for (double offset_mm : {25.0, 21.0}) {
    options.offset_mm = offset_mm;
    EXPECT_THROW((void)laid(rectangle(true), options), Error) << offset_mm;
  }
  options.offset_mm = 60.0;
  EXPECT_THROW((void)laid(circle(50.0, true), options), Error);
  EXPECT_NO_THROW((void)laid(circle(50.0, false), options));
}

TEST(FromContour, AxesLeanTowardsTheVoidAndTheTravel) {
  FromContourOptions options;
  options.lateral_rad = 0.3;
  for (const PathPoint& row : laid(circle(50.0, true), options).points) {
    const Vector3d inwards = -row.tip_mm.normalized();
    EXPECT_NEAR(row.axis.dot(inwards), std::sin(0.3), 1e-3);
    EXPECT_NEAR(row.axis.z(), std::cos(0.3), 1e-9);
  }
  options.lateral_rad = 0.0;
  options.lead_rad = 0.2;
  for (bool reversed : {false, true}) {
    options.reversed = reversed;
    const ToolPath path = laid(circle(50.0, true), options);
    const std::vector<Vector3d> travel = directions(path);
    for (std::size_t i = 0; i < path.points.size(); ++i)
      EXPECT_NEAR(path.points[i].axis.dot(travel[i]), std::sin(0.2), 1e-3);
  }
}

TEST(FromContour, SeamAndDirectionAreChosen) {
  FromContourOptions options;
  options.seam_mm = 0.25 * kTwoPi * 50.0;
  options.reversed = true;
  const ToolPath path = laid(circle(50.0, false), options);
  EXPECT_LT((path.points.front().tip_mm - Vector3d(0.0, 50.0, 0.0)).norm(), 0.01);
  EXPECT_GT(path.points[1].tip_mm.x(), 0.5);  // clockwise
}

TEST(FromContour, ApproachAndRetractCloseTheCutAndOpenThePolyline) {
  FromContourOptions options;
  options.offset_mm = 2.0;
  options.lateral_rad = 0.2;
  options.approach_mm = 10.0;
  options.retract_mm = 20.0;
  options.feed_mm_s = 15.0;
  const ToolPath path = laid(circle(50.0, true), options);
  const std::size_t n = path.points.size();
  EXPECT_FALSE(path.points.front().closed);
  EXPECT_EQ(path.points[1].tip_mm, path.points[n - 2].tip_mm);
  EXPECT_LT((path.points[0].tip_mm - path.points[1].tip_mm - 10.0 * path.points[1].axis).norm(), 1e-9);
  EXPECT_LT((path.points[n - 1].tip_mm - path.points[n - 2].tip_mm - 20.0 * path.points[n - 2].axis).norm(),
            1e-9);
  EXPECT_EQ(path.points[5].feed_mm_s, 15.0);
  EXPECT_TRUE(path.has_feed_column);
}

TEST(FromContour, CurvedSurfacesGiveOffsetsInTheirOwnPlane) {
  Contour saddle;  // the rim of a hole on a cylinder of radius 200 about y
  saddle.closed = true;
  for (int i = 0; i < 360; ++i) {
    const double angle = -kTwoPi * i / 360, phi = 60.0 * std::cos(angle) / 200.0;
    saddle.points_mm.emplace_back(200.0 * std::sin(phi), 60.0 * std::sin(angle), 200.0 * std::cos(phi));
    saddle.normals.emplace_back(std::sin(phi), 0.0, std::cos(phi));
  }
  FromContourOptions options;
  options.offset_mm = 4.0;
  const Curve curve(saddle);
  for (const PathPoint& row : laid(saddle, options).points) {
    const CurveFoot foot = curve.nearest(row.tip_mm);
    EXPECT_NEAR(foot.distance_mm, 4.0, 0.05);
    EXPECT_NEAR((row.tip_mm - foot.foot_mm).dot(row.axis), 0.0, 0.05);
  }
}

TEST(FromContour, OpenContoursKeepTheirEnds) {
  Contour open = rectangle(false);
  open.closed = false;
  const ToolPath path = laid(open, {});
  EXPECT_EQ(path.points.front().tip_mm, open.points_mm.front());
  EXPECT_EQ(path.points.back().tip_mm, open.points_mm.back());
  EXPECT_FALSE(path.points.front().closed);
}

TEST(FromContour, SeveralContoursBecomePolylines) {
  const std::vector<Contour> both = {circle(50.0, true), rectangle(true)};
  const ToolPath path = path_from_contours(both, {});
  EXPECT_EQ(polylines(path).size(), 2u);
  EXPECT_TRUE(path.has_path_column);
  EXPECT_EQ(path.source, "from contours 4, 2");
}

TEST(FromContour, BadContoursAndOptionsAreErrors) {
  const auto fault_of = [](const Contour& contour, const FromContourOptions& options) {
    try {
      (void)laid(contour, options);
    } catch (const Error& error) {
      return error.fault();
    }
    return Fault::kBug;
  };
  Contour bare = circle(50.0, true);
  bare.normals.clear();
  EXPECT_EQ(fault_of(bare, {}), Fault::kInput);
  Contour point = rectangle(true);
  point.points_mm.assign(4, Vector3d::Zero());
  EXPECT_EQ(fault_of(point, {}), Fault::kInput);
  Contour along = rectangle(true);
  along.normals.assign(4, Vector3d::UnitX());
  EXPECT_EQ(fault_of(along, {}), Fault::kInput);
  FromContourOptions seam;
  seam.seam_mm = 3.0;
  Contour open = rectangle(true);
  open.closed = false;
  EXPECT_EQ(fault_of(open, seam), Fault::kRecipe);
  FromContourOptions step;
  step.step_mm = 0.0;
  EXPECT_EQ(fault_of(bare, step), Fault::kRecipe);
  FromContourOptions lean;
  lean.lateral_rad = 1.6;
  EXPECT_EQ(fault_of(bare, lean), Fault::kRecipe);
  EXPECT_THROW((void)path_from_contours({}, {}), Error);
}

}  // namespace
}  // namespace arris
