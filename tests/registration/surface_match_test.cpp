#include "registration/surface_match.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "registration/coarse_align.hpp"
#include "registration/fpfh.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Points and normals of a surface over a square of 300 mm, 6 mm apart, unevenly.
struct Patch {
  std::vector<Eigen::Vector3d> points_mm, normals;
};
template <typename Point>
Patch patch_of(Point&& point_mm) {
  Patch patch;
  synthetic::Random random(9);
  for (double x = -150.0; x < 150.0; x += 6.0)
    for (double y = -150.0; y < 150.0; y += 6.0) {
      const double u = x + random.uniform(-2.0, 2.0), v = y + random.uniform(-2.0, 2.0);
      patch.points_mm.push_back(point_mm(u, v));
      const Eigen::Vector3d along = point_mm(u + 0.01, v) - point_mm(u - 0.01, v);
      patch.normals.push_back(along.cross(point_mm(u, v + 0.01) - point_mm(u, v - 0.01)).normalized());
    }
  return patch;
}

Eigen::Vector3d plane(double u, double v) {
  return {u, v, 0.0};
}
Eigen::Vector3d cylinder(double u, double v) {
  return {250.0 * std::sin(u / 250.0), v, 250.0 * std::cos(u / 250.0)};
}
Eigen::Vector3d sphere(double u, double v) {
  return 300.0 * Eigen::Vector3d(u, v, 300.0).normalized();
}
Eigen::Vector3d bumps(double u, double v) {
  return {u, v, 25.0 * std::sin(u / 45.0 + 0.4) * std::cos(v / 60.0) + 10.0 * std::sin((u + 2.0 * v) / 70.0)};
}

ScanModel scan_of(const Patch& patch, const RigidMotion& motion) {
  Scan scan;
  for (std::size_t i = 0; i < patch.points_mm.size(); ++i) {
    scan.cloud.points_mm.push_back((motion * patch.points_mm[i]).cast<float>());
    scan.cloud.normals.push_back((motion.linear() * patch.normals[i]).cast<float>());
  }
  return prepare_scan(scan, {}).model;
}

/// The surface over the square as triangles, and a round contour on it about the middle.
CadModel drawing_of(Eigen::Vector3d (*point_mm)(double, double)) {
  TriangleMesh mesh;
  constexpr int kAcross = 40;
  for (int i = 0; i <= kAcross; ++i)
    for (int k = 0; k <= kAcross; ++k)
      mesh.vertices_mm.push_back(point_mm(-150.0 + 300.0 * i / kAcross, -150.0 + 300.0 * k / kAcross));
  for (int i = 0; i < kAcross; ++i)
    for (int k = 0; k < kAcross; ++k) {
      const std::int32_t a = i * (kAcross + 1) + k, b = a + kAcross + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  Contour contour;
  contour.closed = true;
  for (int i = 0; i < 200; ++i) {
    const double angle_rad = -2.0 * kPi * i / 200.0;
    contour.points_mm.push_back(point_mm(90.0 * std::cos(angle_rad), 90.0 * std::sin(angle_rad)));
    contour.normals.push_back(Eigen::Vector3d::UnitZ());
  }
  return prepare_cad(mesh, {contour});
}

TEST(Fpfh, DoesNotChangeWhenPointsAndNormalsMoveTogether) {
  const Patch patch = patch_of(bumps);
  synthetic::Random random(2);
  const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, 1.3, 400.0);
  Patch moved = patch;
  for (Eigen::Vector3d& p : moved.points_mm) p = motion * p;
  for (Eigen::Vector3d& n : moved.normals) n = motion.linear() * n;
  const std::vector<Fpfh> before = fpfh_of(patch.points_mm, patch.normals, 30.0, 1);
  const std::vector<Fpfh> after = fpfh_of(moved.points_mm, moved.normals, 30.0, 2);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT(distance2(before[i], after[i]), 1e-4F) << i;  // a pair on the border of two bins may change
}

TEST(Fpfh, APlaneLooksTheSameEverywhereAndBumpsDoNot) {
  const auto spread = [](const Patch& patch) {
    const std::vector<Fpfh> all = fpfh_of(patch.points_mm, patch.normals, 30.0, 1);
    double sum = 0.0;
    for (const Fpfh& one : all) sum += distance2(one, all[all.size() / 2]) / double(all.size());
    return sum;
  };
  EXPECT_GT(spread(patch_of(bumps)), 5.0 * spread(patch_of(plane)));
}

TEST(MatchSurfaces, FindsTheMotionOfAShapedSurfaceWithoutAnyContour) {
  const CadModel cad = drawing_of(bumps);
  const Patch patch = patch_of(bumps);
  synthetic::Random random(4);
  for (int i = 0; i < 5; ++i) {
    const RigidMotion truth = scenes::disturbance(random, {0, 0, 0}, random.uniform(0.0, kPi), 300.0);
    const ScanModel scan = scan_of(patch, truth);
    double nearest_mm = 1e300;
    for (const RigidMotion& motion : match_surfaces(cad, scan, scan.spacing_mm, 60.0, 1)) {
      double off_mm = 0.0;
      for (const Eigen::Vector3d& p : cad.contours[0].contour().points_mm)
        off_mm = std::max(off_mm, (motion * p - truth * p).norm());
      nearest_mm = std::min(nearest_mm, off_mm);
    }
    EXPECT_LT(nearest_mm, 10.0) << i;
  }
}

TEST(MatchSurfaces, TheSameMotionsForAnyNumberOfThreads) {
  const CadModel cad = drawing_of(bumps);
  const ScanModel scan = scan_of(patch_of(bumps), RigidMotion(Eigen::Translation3d(1.0, 2.0, 3.0)));
  const std::vector<RigidMotion> one = match_surfaces(cad, scan, scan.spacing_mm, 60.0, 1);
  const std::vector<RigidMotion> three = match_surfaces(cad, scan, scan.spacing_mm, 60.0, 3);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].matrix(), three[i].matrix());
}

/// A surface that shows no edge where the drawing has one is not the part, whatever its shape.
TEST(MatchSurfaces, APlaneACylinderAndASphereAreRefused) {
  for (const auto shape : {plane, cylinder, sphere}) {
    synthetic::Random random(5);
    const RigidMotion motion = scenes::disturbance(random, {0, 0, 0}, 1.0, 100.0);
    const ScanModel scan = scan_of(patch_of(shape), motion);
    for (const CadModel& cad : {drawing_of(bumps), drawing_of(shape)}) {
      const CoarseAlignment found = coarse_align(cad, scan, {});
      EXPECT_FALSE(found.usable()) << found.start << ", " << found.score_mm;
      EXPECT_FALSE(found.reason.empty());
    }
  }
}

}  // namespace
}  // namespace arris
