// A path on the far face of a plate rolled onto a cylinder: closed form.
#include <gtest/gtest.h>

#include "tests/toolpath/plate.hpp"

namespace arris {
namespace {

constexpr double kThicknessMm = 10.0, kRadiusMm = 500.0, kDepthMm = 1.5;

/// Rows below the plate: on its far face, `kDepthMm` into the material, axes out of that face.
ToolPath far_path() {
  ToolPath path = test::straight_path(-kThicknessMm + kDepthMm);
  for (PathPoint& row : path.points) row.axis = -Eigen::Vector3d::UnitZ();
  return path;
}

CorrectOptions far_options() {
  CorrectOptions options;
  options.far_face_mm = kThicknessMm;
  options.max_correction_mm = 50.0;
  return options;
}

TEST(FarFace, DepthAndAxisStayTrueOnTheBentPlate) {
  const SurfaceQuery cad(test::plate_mesh());
  const test::CylinderBend bend(kRadiusMm);
  const Correction found = correct(far_path(), cad, bend, RigidMotion::Identity(), far_options());
  ASSERT_TRUE(found.accepted()) << found.reasons.front();
  const ToolPath nominal = far_path();
  for (std::size_t i = 0; i < found.points.size(); ++i) {
    const double phi = nominal.points[i].tip_mm.x() / kRadiusMm, r_mm = kRadiusMm - kThicknessMm + kDepthMm;
    const Eigen::Vector3d tip_mm(r_mm * std::sin(phi), 0.0, r_mm * std::cos(phi) - kRadiusMm);
    EXPECT_LT((found.points[i].point.tip_mm - tip_mm).norm(), 1e-9);
    const Eigen::Vector3d axis(-std::sin(phi), 0.0, -std::cos(phi));
    EXPECT_LT((found.points[i].point.axis - axis).norm(), 1e-9);
    EXPECT_NEAR(found.points[i].foot_distance_mm, kDepthMm, 1e-9);
  }
}

TEST(FarFace, ShiftsAreOutOfTheFarFace) {
  const SurfaceQuery cad(test::plate_mesh());
  RigidMotion lifted = RigidMotion::Identity();
  lifted.translation().z() = 0.75;  // towards the scanner: into the material of the far face
  lifted.translation().y() = 0.25;  // with travel along x and the far normal -z, the right is +y
  const Correction far = correct(far_path(), cad, RigidField(lifted), RigidMotion::Identity(), far_options());
  const Correction near =
      correct(test::straight_path(), cad, RigidField(lifted), RigidMotion::Identity(), CorrectOptions());
  for (std::size_t i = 0; i < far.points.size(); ++i) {
    EXPECT_NEAR(far.points[i].shift_normal_mm, -0.75, 1e-12);
    EXPECT_NEAR(near.points[i].shift_normal_mm, 0.75, 1e-12);
    EXPECT_NEAR(far.points[i].shift_across_mm, 0.25, 1e-12);
    EXPECT_NEAR(near.points[i].shift_across_mm, -0.25, 1e-12);
  }
}

TEST(FarFace, UncertaintyGrowsByTheLeverThroughTheThickness) {
  const SurfaceQuery cad(test::plate_mesh());
  const test::CylinderBend bend(kRadiusMm);  // sd 0.02 across, 0.001 rad
  const Correction found = correct(far_path(), cad, bend, RigidMotion::Identity(), far_options());
  EXPECT_NEAR(found.points[50].sd_across_mm, std::hypot(0.02, 0.001 * (kThicknessMm - kDepthMm)), 1e-9);
  EXPECT_NEAR(found.points[50].sd_normal_mm, 0.01, 1e-9);
}

TEST(FarFace, ReachIsCountedFromTheFarFace) {
  const SurfaceQuery cad(test::plate_mesh());
  ToolPath path = far_path();
  path.points.front().tip_mm.z() = -kThicknessMm - 4.0;
  path.points.back().tip_mm.z() = -kThicknessMm - 6.0;
  CorrectOptions options = far_options();
  options.path_reach_mm = 5.0;
  const Correction found =
      correct(path, cad, RigidField(RigidMotion::Identity()), RigidMotion::Identity(), options);
  EXPECT_FALSE(found.points.front().air_move);
  EXPECT_TRUE(found.points.back().air_move);
}

}  // namespace
}  // namespace arris
