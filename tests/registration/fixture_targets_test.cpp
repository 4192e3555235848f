// The scanner's frame from fixture targets, against places that are known because they were put there.
#include "registration/fixture_targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fixtures/synthetic/target_scan.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using synthetic::Random;
using synthetic::TargetScanOptions;

RigidMotion random_motion(Random& random, double reach_mm) {
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = random.rotation().toRotationMatrix();
  for (int axis = 0; axis < 3; ++axis) motion.translation()[axis] = random.uniform(-reach_mm, reach_mm);
  return motion;
}

std::vector<FixtureTarget> five_spheres(double sd_mm = 0.0) {
  return {{"A", TargetKind::kSphere, {1000, 200, 150}, 38.1, sd_mm},
          {"B", TargetKind::kSphere, {1420, 260, 210}, 38.1, sd_mm},
          {"C", TargetKind::kSphere, {1350, -190, 130}, 38.1, sd_mm},
          {"D", TargetKind::kSphere, {960, -150, 260}, 38.1, sd_mm},
          {"E", TargetKind::kSphere, {1180, 330, 320}, 38.1, sd_mm}};
}

/// A scan of spheres: the scanner looks along -z of the robot's frame, its own frame lies anywhere.
struct Scene {
  std::vector<Vector3d> points_mm, normals;
  RigidMotion scan_from_robot = RigidMotion::Identity();

  void sphere(const Vector3d& centre_robot_mm, double diameter_mm, const TargetScanOptions& options,
              Random& random) {
    synthetic::add_cap(scan_from_robot * centre_robot_mm, 0.5 * diameter_mm,
                       scan_from_robot.linear() * Vector3d::UnitZ(), options, random, points_mm, normals);
  }
  void at(const Vector3d& p_robot_mm) { points_mm.push_back(scan_from_robot * p_robot_mm); }
  [[nodiscard]] TargetFrame solve(const std::vector<FixtureTarget>& list,
                                  const TargetOptions& options = {}) const {
    return solve_targets(list, points_mm, {}, options);
  }
};

Scene scene_of(const std::vector<FixtureTarget>& list, const TargetScanOptions& options, Random& random) {
  Scene scene;
  scene.scan_from_robot = random_motion(random, 500.0);
  for (const FixtureTarget& target : list) scene.sphere(target.place_mm, target.diameter_mm, options, random);
  return scene;
}

TargetScanOptions exact() {
  TargetScanOptions options;
  options.noise_sigma_mm = 0.0;
  options.spacing_mm = 1.5;
  return options;
}

/// How far the frame puts points of the robot's workspace from where they are.
double error_mm(const TargetFrame& frame, const Scene& scene, const std::vector<FixtureTarget>& list) {
  double most_mm = 0.0;
  for (const FixtureTarget& target : list)
    most_mm = std::max(
        most_mm,
        (frame.robot_from_scan * (scene.scan_from_robot * target.place_mm) - target.place_mm).norm());
  return most_mm;
}

std::string all_reasons(const TargetFrame& frame) {
  std::string text;
  for (const std::string& reason : frame.reasons) text += reason + "\n";
  return text;
}

TEST(FixtureTargets, AreExactWithoutNoise) {
  Random random(1);
  for (int trial = 0; trial < 5; ++trial) {
    const auto list = five_spheres();
    const Scene scene = scene_of(list, exact(), random);
    const TargetFrame frame = scene.solve(list);
    ASSERT_TRUE(frame.usable()) << all_reasons(frame);
    EXPECT_LT(error_mm(frame, scene, list), 1e-8);
    for (const TargetSighting& sighting : frame.targets) EXPECT_TRUE(sighting.found);
    EXPECT_EQ(frame.extra, 0U);
  }
}

TEST(FixtureTargets, MovingTheScanMovesTheFrameByTheInverse) {
  Random random(2);
  const auto list = five_spheres(0.02);
  const Scene scene = scene_of(list, TargetScanOptions(), random);
  const TargetFrame frame = scene.solve(list);
  ASSERT_TRUE(frame.usable());
  const RigidMotion moved_from_scan = random_motion(random, 400.0);
  Scene moved = scene;
  for (Vector3d& p : moved.points_mm) p = moved_from_scan * p;
  const TargetFrame again = moved.solve(list);
  ASSERT_TRUE(again.usable());
  EXPECT_LT((again.robot_from_scan.matrix() - (frame.robot_from_scan * moved_from_scan.inverse()).matrix())
                .cwiseAbs()
                .maxCoeff(),
            1e-6);
}

TEST(FixtureTargets, OrderOfPointsAndThreadsDoNotMatterToTheDecision) {
  Random random(3);
  const auto list = five_spheres(0.02);
  const Scene scene = scene_of(list, TargetScanOptions(), random);
  TargetOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const TargetFrame a = scene.solve(list, one), b = scene.solve(list, four);
  EXPECT_TRUE(a.robot_from_scan.matrix() == b.robot_from_scan.matrix());
  EXPECT_TRUE(a.covariance == b.covariance);
  EXPECT_EQ(a.points, b.points);
}

TEST(FixtureTargets, StatedCovarianceIsTheScatter) {
  Random random(4);
  const auto truth = five_spheres(0.05);
  TargetScanOptions options;
  options.cap_rad = 0.8;
  options.spacing_mm = 2.0;
  constexpr int kTrials = 250;
  const Vector3d part_mm(1900.0, -300.0, 100.0);  // a lever beyond the targets
  Eigen::Matrix<double, 6, 6> scatter = Eigen::Matrix<double, 6, 6>::Zero(), stated = scatter;
  Eigen::Matrix3d at_part = Eigen::Matrix3d::Zero(), stated_at_part = at_part;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Scene scene = scene_of(truth, options, random);
    auto list = truth;  // the list is off by its own standard deviation
    for (FixtureTarget& target : list)
      for (int axis = 0; axis < 3; ++axis) target.place_mm[axis] += 0.05 * random.normal();
    const TargetFrame frame = scene.solve(list, {.max_residual_mm = 0.5});
    ASSERT_TRUE(frame.usable()) << all_reasons(frame);
    const RigidMotion off = frame.robot_from_scan * scene.scan_from_robot;  // robot from robot
    const Eigen::AngleAxisd turn(off.linear());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), off * frame.pivot_mm - frame.pivot_mm;
    scatter += error * error.transpose() / kTrials;
    stated += frame.covariance / kTrials;
    const Vector3d part_error = off * part_mm - part_mm;
    at_part += part_error * part_error.transpose() / kTrials;
    stated_at_part += carried_covariance_mm2(frame, part_mm) / kTrials;
  }
  for (int i = 0; i < 6; ++i) {
    const double ratio = std::sqrt(stated(i, i) / scatter(i, i));
    EXPECT_GT(ratio, 1.0 / 1.5) << i;
    EXPECT_LT(ratio, 1.5) << i;
  }
  const double ratio = std::sqrt(stated_at_part.trace() / at_part.trace());
  EXPECT_GT(ratio, 1.0 / 1.5);
  EXPECT_LT(ratio, 1.5);
  EXPECT_GT(std::sqrt(at_part.trace()), 0.05);  // the lever is felt
}

/// What else stands in a cell: a bent sheet, a tube and a fillet of the spheres' own radius, spheres of other
/// diameters, strays.
void add_surroundings(Scene& scene, Random& random) {
  const double noise_mm = 0.05;
  for (int i = 0; i < 2500; ++i) {  // a sheet bent to a radius of 400 mm
    const double x = random.uniform(-150, 150), y = random.uniform(-150, 150);
    scene.at({1200 + x, 40 + y, 100 - x * x / 800 + noise_mm * random.normal()});
  }
  for (int i = 0; i < 1500; ++i) {  // a tube of the spheres' radius
    const double turn = random.uniform(0, 3.1416), r = 19.05 + noise_mm * random.normal();
    scene.at({1100 + random.uniform(-100, 100), -320 + r * std::cos(turn), 60 + r * std::sin(turn)});
  }
  for (int i = 0; i < 400; ++i)  // strays
    scene.at({random.uniform(900, 1500), random.uniform(-400, 400), random.uniform(0, 400)});
  const TargetScanOptions options;
  scene.sphere({1250, -330, 180}, 34.0, options, random);
  scene.sphere({900, 60, 100}, 42.0, options, random);
}

TEST(SlowFixtureTargets, AreRightOrRefusedInTwoHundredCells) {
  Random random(5);
  const auto list = five_spheres(0.02);
  int right = 0, few = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene;
    scene.scan_from_robot = random_motion(random, 500.0);
    TargetScanOptions options;
    options.cap_rad = random.uniform(0.6, 1.5);
    int shown = 0;
    for (const FixtureTarget& target : list) {
      if (random.uniform() < 0.25) continue;
      ++shown;
      scene.sphere(target.place_mm, target.diameter_mm, options, random);
    }
    const auto extra = random.index(4);
    for (std::uint64_t k = 0; k < extra; ++k)  // spheres of the same diameter that are no targets
      scene.sphere({random.uniform(900, 1500), random.uniform(-400, -220), random.uniform(220, 400)}, 38.1,
                   options, random);
    add_surroundings(scene, random);
    const TargetFrame frame = scene.solve(list);
    if (!frame.usable()) {
      few += shown < 3;
      EXPECT_LT(shown, 4) << all_reasons(frame);
      continue;
    }
    ++right;
    ASSERT_GE(shown, 3);
    ASSERT_LT(error_mm(frame, scene, list), 0.3) << "trial " << trial;
  }
  EXPECT_GT(right, 150);
  EXPECT_GT(few, 5);
}

TEST(FixtureTargets, AMovedOneIsRefusedByName) {
  Random random(6);
  for (std::size_t moved = 0; moved < 5; ++moved) {
    auto list = five_spheres(0.02);
    list[moved].id.append(300, 'x');  // a name of any length leaves the sentence whole
    auto now = list;
    now[moved].place_mm += 1.0 * random.direction();
    const TargetFrame frame = scene_of(now, TargetScanOptions(), random).solve(list);
    ASSERT_FALSE(frame.usable());
    EXPECT_NE(frame.reasons.front().find("fixture target " + list[moved].id + " is "), std::string::npos)
        << all_reasons(frame);
    EXPECT_NE(frame.reasons.front().find("line in the list is wrong"), std::string::npos)
        << all_reasons(frame);
  }
}

TEST(FixtureTargets, OfTwoUsesTooFewAndNoneIsSaid) {
  Random random(7);
  const auto list = five_spheres();
  EXPECT_NE(all_reasons(scene_of({list[0], list[1]}, TargetScanOptions(), random).solve(list))
                .find("2 possible fixture targets found in the scan; 3 are needed"),
            std::string::npos);
  Scene sheet;
  add_surroundings(sheet, random);
  EXPECT_NE(all_reasons(sheet.solve(list)).find("no fixture target was found"), std::string::npos);
}

TEST(FixtureTargets, OnALineAreRefused) {
  Random random(8);
  auto list = five_spheres();
  list[1].place_mm = list[0].place_mm + Vector3d(150, 2, 0);
  list[2].place_mm = list[0].place_mm + Vector3d(380, -3, 2);
  const Scene scene = scene_of({list[0], list[1], list[2]}, TargetScanOptions(), random);
  EXPECT_NE(all_reasons(scene.solve(list)).find("nearly on a line"), std::string::npos);
  EXPECT_EQ(why_list_is_unusable(list, 0.2), "");
  EXPECT_NE(why_list_is_unusable(std::span(list).first(3), 0.2).find("on a line"), std::string::npos);
}

TEST(FixtureTargets, ThatLookTheSameAfterATurnAreRefused) {
  Random random(9);
  auto list = five_spheres();
  list.resize(3);
  list[2].place_mm = 0.5 * (list[0].place_mm + list[1].place_mm) +
                     200.0 * (list[1].place_mm - list[0].place_mm).unitOrthogonal();
  EXPECT_NE(why_list_is_unusable(list, 0.2).find("A for B"), std::string::npos);
  const TargetFrame frame = scene_of(list, TargetScanOptions(), random).solve(list);
  EXPECT_NE(all_reasons(frame).find("in two ways"), std::string::npos);
  EXPECT_EQ(why_list_is_unusable(five_spheres(), 0.2), "");
}

TEST(FixtureTargets, AMirroredScanIsNamed) {
  Random random(10);
  const auto list = five_spheres();
  Scene scene = scene_of(list, TargetScanOptions(), random);
  for (Vector3d& p : scene.points_mm) p.y() = -p.y();
  EXPECT_NE(all_reasons(scene.solve(list)).find("mirror image"), std::string::npos);
}

TEST(FixtureTargets, AListInAnotherUnitIsNamed) {
  Random random(11);
  const auto list = five_spheres();
  const Scene scene = scene_of(list, TargetScanOptions(), random);
  for (const double ratio : {25.4, 1000.0, 10.0}) {
    auto other = list;
    for (FixtureTarget& target : other) target.place_mm /= ratio;
    const TargetFrame places = scene.solve(other);
    EXPECT_NEAR(places.unit_ratio, ratio, 1e-9);
    EXPECT_NE(all_reasons(places).find("another unit"), std::string::npos);
    for (FixtureTarget& target : other) target.diameter_mm /= ratio;
    EXPECT_NEAR(scene.solve(other).unit_ratio, ratio, 1e-9);
  }
}

TEST(FixtureTargets, PointsOfTheScannersSoftwareServeAsWell) {
  Random random(12);
  auto list = five_spheres(0.01);
  for (std::size_t t = 2; t < 5; ++t) {
    list[t].kind = TargetKind::kPoint;
    list[t].diameter_mm = 0.0;
  }
  const Scene scene = scene_of({list[0], list[1]}, exact(), random);
  std::vector<ScanTarget> points;
  for (std::size_t t = 5; t-- > 2;) points.push_back({scene.scan_from_robot * list[t].place_mm, 0.02});
  points.push_back({Vector3d(3, 4, 5), -1.0});  // a marker on the part
  const TargetFrame frame = solve_targets(list, scene.points_mm, points, {});
  ASSERT_TRUE(frame.usable()) << all_reasons(frame);
  EXPECT_LT(error_mm(frame, scene, list), 1e-6);
  EXPECT_EQ(frame.extra, 1U);
}

TEST(FixtureTargets, TheirPointsAreThoseOnTheSpheresFound) {
  Random random(13);
  const auto list = five_spheres(0.02);
  Scene scene = scene_of(list, TargetScanOptions(), random);
  const std::size_t on = scene.points_mm.size();
  add_surroundings(scene, random);
  const TargetFrame frame = scene.solve(list, {.clear_mm = 0.0});
  ASSERT_TRUE(frame.usable());
  std::size_t theirs = 0;
  for (const std::int32_t i : frame.points) theirs += static_cast<std::size_t>(i) < on;
  EXPECT_EQ(theirs, on);
  EXPECT_LE(frame.points.size(), on + 10);  // a stray or two inside
  EXPECT_GT(scene.solve(list, {.clear_mm = 60.0}).points.size(), frame.points.size() + 10);
}

}  // namespace
}  // namespace arris
