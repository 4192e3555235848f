#pragma once

#include <cmath>
#include <functional>

#include "toolpath/correct.hpp"

namespace arris::test {

/// A flat plate of 400 x 200 mm at z = 0, normals +z, with its centre at the origin; optionally a square
/// ring: the quads whose centre lies within hole_half_mm of the origin are left out.
inline TriangleMesh plate_mesh(double hole_half_mm = 0.0) {
  TriangleMesh mesh;
  const int nx = 40, ny = 20;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.vertices_mm.emplace_back(-200.0 + 10.0 * i, -100.0 + 10.0 * j, 0.0);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x_mm = -195.0 + 10.0 * i, y_mm = -95.0 + 10.0 * j;
      if (std::max(std::abs(x_mm), std::abs(y_mm)) < hole_half_mm) continue;
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// The plate rolled onto a cylinder along y: x becomes arc length; the centre line x = 0 stays where it is.
class CylinderBend final : public DeformationField {
 public:
  explicit CylinderBend(double radius_mm, double half_domain_mm = 1e9)
      : radius_mm_(radius_mm), half_domain_mm_(half_domain_mm) {}
  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p) const override {
    const double phi = p.x() / radius_mm_;
    MappedPoint mapped;
    mapped.p_scan_mm << (radius_mm_ + p.z()) * std::sin(phi), p.y(),
        (radius_mm_ + p.z()) * std::cos(phi) - radius_mm_;
    mapped.rotation_scan_from_cad = Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitY()).toRotationMatrix();
    mapped.sd_mm << 0.01, 0.02, 0.03;
    mapped.sd_axis_rad = 0.001;
    mapped.from_data = p.x() < 50.0;
    mapped.in_domain = std::abs(p.x()) <= half_domain_mm_;
    return mapped;
  }
  [[nodiscard]] std::string method() const override { return "cylinder"; }
  [[nodiscard]] std::vector<double> parameters() const override { return {radius_mm_}; }

 private:
  double radius_mm_, half_domain_mm_;
};

/// A field given by a function, for faults.
class AnyField final : public DeformationField {
 public:
  explicit AnyField(std::function<MappedPoint(const Eigen::Vector3d&)> map) : map_(std::move(map)) {}
  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p) const override { return map_(p); }
  [[nodiscard]] std::string method() const override { return "any"; }
  [[nodiscard]] std::vector<double> parameters() const override { return {}; }

 private:
  std::function<MappedPoint(const Eigen::Vector3d&)> map_;
};

/// Rows along x at y = 0, `height_mm` above the plate, every 2 mm from x = -100 to 100; axes +z.
inline ToolPath straight_path(double height_mm = 0.0) {
  ToolPath path;
  path.source = "straight.csv";
  for (int i = 0; i <= 100; ++i) {
    PathPoint row;
    row.tip_mm << -100.0 + 2.0 * i, 0.0, height_mm;
    path.points.push_back(row);
  }
  return path;
}

inline RigidMotion some_motion() {
  RigidMotion motion = RigidMotion::Identity();
  motion.linear() = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  motion.translation() << 812.25, -31.5, 440.125;
  return motion;
}

}  // namespace arris::test
