#include "registration/path_symmetry.hpp"

#include <gtest/gtest.h>

#include "fixtures/synthetic/analytic_part.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The opening of a flat plate, about its own middle.
Contour opening(double half_x_mm, double half_y_mm, double corner_radius_mm) {
  synthetic::PlateShape shape;
  shape.holes.push_back({{0.0, 0.0}, half_x_mm, half_y_mm, corner_radius_mm, 0.0});
  return synthetic::PlatePart(shape).nominal_contour(0, 1.0);
}

RigidMotion turned(double angle_rad) {
  return RigidMotion(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

TEST(PathSymmetry, ARectangleHasItsHalfTurnAndNothingElse) {
  const PathSymmetry path({opening(80.0, 50.0, 5.0)});
  synthetic::Random random(1);
  for (int i = 0; i < 10; ++i) {  // as a search finds it, some millimetres and degrees off
    const RigidMotion near = scenes::disturbance(random, {0, 0, 0}, 0.03, 3.0) * turned(kPi);
    EXPECT_TRUE(path.maps_onto_itself(near)) << i;
  }
  for (const double angle_rad : {0.5 * kPi, 0.25 * kPi, 1.0, 2.5})
    EXPECT_FALSE(path.maps_onto_itself(turned(angle_rad))) << angle_rad;
}

TEST(PathSymmetry, AQuarterTurnIsOneOfASquareAndNotOfWhatIsOnlyNearlySquare) {
  EXPECT_TRUE(PathSymmetry({opening(60.0, 60.0, 10.0)}).maps_onto_itself(turned(0.5 * kPi)));
  EXPECT_FALSE(PathSymmetry({opening(60.0, 59.0, 10.0)}).maps_onto_itself(turned(0.5 * kPi)));
}

TEST(PathSymmetry, ACircleHasEveryTurn) {
  const PathSymmetry path({opening(40.0, 40.0, 40.0)});
  for (double angle_rad = 0.1; angle_rad < 6.2; angle_rad += 0.7)
    EXPECT_TRUE(path.maps_onto_itself(turned(angle_rad))) << angle_rad;
}

TEST(PathSymmetry, TheFarthestPlaceIsMeasuredWithoutSettling) {
  const PathSymmetry path({opening(60.0, 50.0, 5.0)});
  EXPECT_NEAR(path.farthest_off_mm(turned(kPi)), 0.0, 1e-6);
  EXPECT_NEAR(path.farthest_off_mm(RigidMotion(Eigen::Translation3d(0.0, 0.0, 3.0))), 3.0, 1e-6);
  EXPECT_NEAR(path.farthest_off_mm(turned(0.5 * kPi)), 10.0, 0.1);  // the long side over the short one
}

TEST(PathSymmetry, AxesCountAndSoDoesEveryPolyline) {
  Contour leaning = opening(80.0, 50.0, 5.0);
  for (Eigen::Vector3d& axis : leaning.normals) axis = Eigen::Vector3d(0.2, 0.0, 1.0).normalized();
  EXPECT_FALSE(PathSymmetry({leaning}).maps_onto_itself(turned(kPi)));
  Contour approach;  // from one side
  approach.points_mm = {{80.0, 0.0, 30.0}, {80.0, 0.0, 0.0}};
  approach.normals = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()};
  EXPECT_FALSE(PathSymmetry({opening(80.0, 50.0, 5.0), approach}).maps_onto_itself(turned(kPi)));
  EXPECT_FALSE(PathSymmetry({}).maps_onto_itself(turned(kPi)));
}

}  // namespace
}  // namespace arris
