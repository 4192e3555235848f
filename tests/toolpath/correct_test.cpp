#include "toolpath/correct.hpp"

#include <gtest/gtest.h>

#include "acquisition/types/error.hpp"
#include "tests/toolpath/plate.hpp"

namespace arris {
namespace {

using test::AnyField;
using test::CylinderBend;
using test::plate_mesh;
using test::some_motion;
using test::straight_path;

const RigidMotion kHome = RigidMotion::Identity();

// A round trip in a hole: beside the edge, below the face, axes leant over, feeds and polyline of their own.
ToolPath hole_path() {
  ToolPath path;
  for (int i = 0; i < 72; ++i) {
    const double angle = i * 5.0 * 0.017453292519943295;
    PathPoint row;
    row.tip_mm << 44.0 * std::cos(angle), 44.0 * std::sin(angle), -1.5;
    row.axis = Eigen::Vector3d(-0.2 * std::cos(angle), -0.2 * std::sin(angle), 1.0).normalized();
    row.path = 7;
    row.feed_mm_s = 10.0 + i;
    row.closed = true;
    path.points.push_back(row);
  }
  return path;
}

TEST(Correct, ZeroFieldLeavesThePathAsItWas) {
  const SurfaceQuery cad(plate_mesh(50.0));
  const ToolPath nominal = hole_path();
  const Correction correction = correct(nominal, cad, RigidField(kHome), kHome, {});
  ASSERT_TRUE(correction.accepted());
  ASSERT_EQ(correction.points.size(), nominal.points.size());
  for (std::size_t i = 0; i < nominal.points.size(); ++i) {
    EXPECT_LT((correction.points[i].point.tip_mm - nominal.points[i].tip_mm).norm(), 1e-12);
    EXPECT_LT((correction.points[i].point.axis - nominal.points[i].axis).norm(), 1e-12);
    EXPECT_LT(correction.points[i].shift_mm, 1e-12);
  }
}

TEST(Correct, RigidFieldMovesRigidlyAndKeepsWhatItMustKeep) {
  const SurfaceQuery cad(plate_mesh(50.0));
  const ToolPath nominal = hole_path();
  const Correction correction = correct(nominal, cad, RigidField(some_motion()), some_motion(), {});
  ASSERT_TRUE(correction.accepted());
  ASSERT_EQ(correction.points.size(), nominal.points.size());
  for (std::size_t i = 0; i < nominal.points.size(); ++i) {
    const CorrectedPoint& row = correction.points[i];
    EXPECT_LT((row.point.tip_mm - some_motion() * nominal.points[i].tip_mm).norm(), 1e-10);
    EXPECT_LT((row.point.axis - some_motion().linear() * nominal.points[i].axis).norm(), 1e-12);
    EXPECT_LT(row.shift_mm, 1e-10);
    EXPECT_LT(row.tilt_rad, 1e-7);
    EXPECT_EQ(row.point.path, 7);
    EXPECT_TRUE(row.point.closed);
    EXPECT_EQ(row.point.feed_mm_s, nominal.points[i].feed_mm_s);
  }
}

TEST(Correct, BendKeepsTheAxisNormalAndTheDepthTrue) {
  const double radius_mm = 600.0, height_mm = 4.0;
  const SurfaceQuery cad(plate_mesh());
  const Correction correction = correct(straight_path(height_mm), cad, CylinderBend(radius_mm), kHome, {});
  ASSERT_TRUE(correction.accepted()) << correction.reasons.front();
  const Eigen::Vector3d centre_mm(0.0, 0.0, -radius_mm);
  for (std::size_t i = 0; i < correction.points.size(); ++i) {
    const CorrectedPoint& row = correction.points[i];
    const Eigen::Vector3d out_mm = row.point.tip_mm - centre_mm;
    EXPECT_NEAR(out_mm.norm(), radius_mm + height_mm, 1e-9);
    EXPECT_LT((row.point.axis - out_mm.normalized()).norm(), 1e-12);
    EXPECT_NEAR(row.tilt_rad, std::abs(-100.0 + 2.0 * static_cast<double>(i)) / radius_mm, 1e-9);
    EXPECT_EQ(row.from_data, i < 75);
  }
}

TEST(Correct, OffsetFromABentEdgeKeepsItsLengthAndItsAngles) {
  const SurfaceQuery cad(plate_mesh(50.0));
  const ToolPath nominal = hole_path();
  const CylinderBend bend(800.0);
  const Correction correction = correct(nominal, cad, bend, kHome, {});
  ASSERT_TRUE(correction.accepted()) << correction.reasons.front();
  for (std::size_t i = 0; i < nominal.points.size(); ++i) {
    const SurfacePoint foot = cad.closest(nominal.points[i].tip_mm);
    const MappedPoint edge = bend.map(foot.foot_mm);
    const Eigen::Vector3d offset_mm = correction.points[i].point.tip_mm - edge.p_scan_mm;
    const Eigen::Vector3d normal = edge.rotation_scan_from_cad.col(2);
    EXPECT_NEAR(offset_mm.norm(), foot.distance_mm, 1e-9);
    EXPECT_NEAR(offset_mm.dot(normal), -1.5, 1e-9);
    EXPECT_NEAR(correction.points[i].point.axis.dot(normal), nominal.points[i].axis.z(), 1e-12);
  }
}

TEST(Correct, ShiftIsResolvedNormalAndAcrossAsSeenFromTheRigidMotion) {
  const SurfaceQuery cad(plate_mesh());
  const AnyField field([](const Eigen::Vector3d& p) {
    MappedPoint mapped;
    mapped.p_scan_mm = some_motion() * (p + Eigen::Vector3d(0.3, -2.0, 1.25));
    mapped.rotation_scan_from_cad = some_motion().linear();
    mapped.in_domain = true;
    return mapped;
  });
  const Correction correction = correct(straight_path(1.0), cad, field, some_motion(), {});
  ASSERT_TRUE(correction.accepted());
  for (const CorrectedPoint& row : correction.points) {
    EXPECT_NEAR(row.shift_mm, std::sqrt(0.09 + 4.0 + 1.5625), 1e-9);
    EXPECT_NEAR(row.shift_normal_mm, 1.25, 1e-9);
    EXPECT_NEAR(row.shift_across_mm, 2.0, 1e-9);  // travel +x, normal +z: right is -y
    EXPECT_EQ(row.sd_normal_mm, 0.0);
  }
}

TEST(Correct, AxisUncertaintyReachesTheTipThroughTheLever) {
  const SurfaceQuery cad(plate_mesh());
  const Correction correction = correct(straight_path(20.0), cad, CylinderBend(1000.0), kHome, {});
  const CorrectedPoint& row = correction.points[50];
  EXPECT_NEAR(row.sd_normal_mm, 0.01, 1e-12);  // the lever is the normal itself
  EXPECT_NEAR(row.sd_across_mm, std::hypot(0.02, 0.001 * 20.0), 1e-12);
  EXPECT_NEAR(row.sd_along_mm, std::hypot(0.03, 0.001 * 20.0), 1e-12);
  EXPECT_NEAR(row.sd_axis_rad, 0.001, 1e-15);
}

TEST(Correct, AirMovesFollowTheNearestRowOfTheirPolyline) {
  ToolPath nominal = straight_path();
  for (double height_mm : {40.0, 80.0}) {  // retract over the last row
    PathPoint row = nominal.points[100];
    row.tip_mm.z() = height_mm;
    nominal.points.push_back(row);
  }
  const SurfaceQuery cad(plate_mesh());
  const CylinderBend bend(1000.0);
  const Correction correction = correct(nominal, cad, bend, kHome, {});
  ASSERT_TRUE(correction.accepted()) << correction.reasons.front();
  ASSERT_EQ(correction.notes.size(), 1u);
  EXPECT_NE(correction.notes[0].find("2 of 103 rows are air moves"), std::string::npos);
  const Eigen::Vector3d axis = correction.points[100].point.axis;
  for (std::size_t i : {101u, 102u}) {
    EXPECT_TRUE(correction.points[i].air_move);
    EXPECT_EQ(correction.points[i].anchor, 100);
    const double above_mm = 40.0 * (static_cast<double>(i) - 100.0);
    const Eigen::Vector3d expected_mm = correction.points[100].point.tip_mm + above_mm * axis;
    EXPECT_LT((correction.points[i].point.tip_mm - expected_mm).norm(), 1e-9);
  }
}

TEST(Correct, AirMovesOfAClosedPolylineLookRoundTheSeam) {
  ToolPath nominal = straight_path();
  for (std::size_t i : {0u, 1u, 2u, 3u}) nominal.points[i].tip_mm.z() = 300.0;
  for (PathPoint& row : nominal.points) row.closed = true;
  nominal.points[100].tip_mm << -100.0, 0.0, 0.0;  // the last row comes back under the first
  CorrectOptions options;
  options.max_correction_mm = 1000.0;
  const Correction correction =
      correct(nominal, SurfaceQuery(plate_mesh()), CylinderBend(2000.0), kHome, options);
  EXPECT_EQ(correction.points[0].anchor, 100);
  EXPECT_EQ(correction.points[3].anchor, 4);
}

TEST(Correct, APolylineThatNeverTouchesFollowsTheNearestRowInSpace) {
  ToolPath nominal = straight_path();
  PathPoint park = nominal.points[30];
  park.tip_mm.z() = 50.0;
  park.path = 2;
  nominal.points.push_back(park);
  const Correction correction = correct(nominal, SurfaceQuery(plate_mesh()), CylinderBend(1000.0), kHome, {});
  EXPECT_TRUE(correction.points[101].air_move);
  EXPECT_EQ(correction.points[101].anchor, 30);
  ASSERT_EQ(correction.notes.size(), 2u);
}

TEST(Correct, SameBytesForAnyNumberOfThreads) {
  const SurfaceQuery cad(plate_mesh());
  CorrectOptions options;
  const Correction one = correct(straight_path(3.0), cad, CylinderBend(700.0), kHome, options);
  options.threads = 4;
  const Correction four = correct(straight_path(3.0), cad, CylinderBend(700.0), kHome, options);
  for (std::size_t i = 0; i < one.points.size(); ++i)
    EXPECT_EQ(one.points[i].point.tip_mm, four.points[i].point.tip_mm);
}

TEST(Correct, PathThatBelongsNowhereIsAnError) {
  ToolPath nominal = straight_path();
  for (PathPoint& row : nominal.points) row.tip_mm.z() = 1000.0;
  nominal.points[17].tip_mm.z() = 812.3;
  try {
    (void)correct(nominal, SurfaceQuery(plate_mesh()), RigidField(kHome), kHome, {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kInput);
    const std::string line = error.what();
    EXPECT_NE(line.find("the path belongs nowhere on the CAD (straight.csv)"), std::string::npos) << line;
    EXPECT_NE(line.find("row 18, the nearest, is 812.3 mm from the CAD, the farthest 1000.0 mm"),
              std::string::npos);
    EXPECT_NE(line.find("a row within 30.0 mm"), std::string::npos);
  }
}

TEST(Correct, BadRowsAndOptionsAreErrors) {
  const SurfaceQuery cad(plate_mesh());
  const auto fault_of = [&](const ToolPath& path, const CorrectOptions& options) {
    try {
      (void)correct(path, cad, RigidField(kHome), kHome, options);
    } catch (const Error& error) {
      return error.fault();
    }
    return Fault::kInterrupted;
  };
  EXPECT_EQ(fault_of(ToolPath{}, {}), Fault::kInput);
  ToolPath nan = straight_path();
  nan.points[3].tip_mm.y() = std::nan("");
  EXPECT_EQ(fault_of(nan, {}), Fault::kInput);
  ToolPath longer = straight_path();
  longer.points[3].axis *= 1.01;
  EXPECT_EQ(fault_of(longer, {}), Fault::kInput);
  CorrectOptions options;
  options.max_tilt_rad = 0.0;
  EXPECT_EQ(fault_of(straight_path(), options), Fault::kRecipe);
  options = {};
  options.path_reach_mm = -1.0;
  EXPECT_EQ(fault_of(straight_path(), options), Fault::kRecipe);
  EXPECT_EQ(fault_of(straight_path(), {}), Fault::kInterrupted);
}

TEST(Correct, AFieldWithoutARotationIsABug) {
  const AnyField sheared([](const Eigen::Vector3d& p) {
    MappedPoint mapped;
    mapped.p_scan_mm = p;
    mapped.rotation_scan_from_cad(0, 1) = 0.01;
    mapped.in_domain = true;
    return mapped;
  });
  EXPECT_THROW((void)correct(straight_path(), SurfaceQuery(plate_mesh()), sheared, kHome, {}), Error);
}

}  // namespace
}  // namespace arris
