#include "registration/shape_about.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace arris {
namespace {

constexpr double kRingSpacings[] = {0.2, 0.4};  // radii, of the nodes' spacing
constexpr int kRingPoints = 8;
constexpr double kNarrowRatio = 1e-4;  // least pivot over the greatest: a strip this narrow turns nothing

/// Sums for the plane u = a + g1 x + g2 y through values u at places (x, y).
struct PlaneSums {
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d values = Eigen::Matrix3d::Zero();  // a column a component of u
  void add(double x, double y, const Eigen::Vector3d& value) {
    const Eigen::Vector3d terms(1.0, x, y);
    moment += terms * terms.transpose();
    values += terms * value.transpose();
  }
};

}  // namespace

LocalShape shape_about(const CadModel& cad, const SurfaceBasis& basis, const Eigen::Vector3d& foot_mm,
                       const BasisRow& row, const std::vector<Eigen::Vector3d>& shift_mm) {
  LocalShape shape = local_shape(row, shift_mm);
  const double spacing_mm = row.spacing_mm;
  PlaneSums sums;
  sums.add(0.0, 0.0, shape.shift_mm);
  for (const double ring : kRingSpacings)
    for (int k = 0; k < kRingPoints; ++k) {
      const double radius_mm = ring * spacing_mm, angle_rad = 2.0 * std::numbers::pi * k / kRingPoints;
      const Eigen::Vector3d aside = std::cos(angle_rad) * row.t1 + std::sin(angle_rad) * row.t2;
      const SurfacePoint near = cad.surface.closest(foot_mm + radius_mm * aside, radius_mm);
      if (near.triangle < 0) continue;
      const BasisRow at = basis.row(near.foot_mm, cad.smooth_normal(near));
      if (!at.usable()) continue;
      const Eigen::Vector3d apart = (near.foot_mm - foot_mm) / spacing_mm;
      sums.add(apart.dot(row.t1), apart.dot(row.t2), at.combine(BasisRow::kValue, shift_mm));
    }
  const Eigen::LDLT<Eigen::Matrix3d> solver(sums.moment);
  if (solver.vectorD().minCoeff() < kNarrowRatio * solver.vectorD().maxCoeff()) return shape;
  const Eigen::Matrix3d plane = solver.solve(sums.values) / spacing_mm;
  shape.f1 = row.t1 + plane.row(1).transpose();
  shape.f2 = row.t2 + plane.row(2).transpose();
  shape.normal = shape.f1.cross(shape.f2).normalized();
  return shape;
}

std::vector<double> edge_slopes(const CadModel& cad, const SurfaceBasis& basis,
                                const std::vector<std::vector<ContourStation>>& contours,
                                const std::vector<Eigen::Vector3d>& shift_mm) {
  std::vector<double> slopes;
  for (const std::vector<ContourStation>& stations : contours)
    for (const ContourStation& at : stations) {
      const LocalShape shape = shape_about(cad, basis, at.point_mm, at.row, shift_mm);
      const Eigen::Vector3d inward =
          at.inward.dot(at.row.t1) * shape.f1 + at.inward.dot(at.row.t2) * shape.f2;
      slopes.push_back(at.row.normal.dot(inward));
    }
  return slopes;
}

}  // namespace arris
