#include "registration/segment_costs.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace arris {
namespace {

constexpr double kSmallTurnRad = 1e-4;  // below it the series are exact to rounding

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad) {
  const double angle_rad = turn_rad.norm();
  if (angle_rad == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad).toRotationMatrix();
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& turn_rad) {
  const double t2 = turn_rad.squaredNorm(), t = std::sqrt(t2);
  const bool small = t < kSmallTurnRad;
  const double first = small ? 0.5 - t2 / 24.0 : (1.0 - std::cos(t)) / t2;
  const double second = small ? 1.0 / 6.0 - t2 / 120.0 : (t - std::sin(t)) / (t2 * t);
  const Eigen::Matrix3d w = cross_matrix(turn_rad);
  return Eigen::Matrix3d::Identity() + first * w + second * w * w;
}

Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& turn_rad) {
  const double t2 = turn_rad.squaredNorm(), t = std::sqrt(t2);
  const double second =
      t < kSmallTurnRad ? 1.0 / 12.0 + t2 / 720.0 : 1.0 / t2 - (1.0 + std::cos(t)) / (2.0 * t * std::sin(t));
  const Eigen::Matrix3d w = cross_matrix(turn_rad);
  return Eigen::Matrix3d::Identity() + 0.5 * w + second * w * w;
}

Eigen::Vector3d turn_of(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Vector3d Carrier::moved_mm(const SegmentStep& step) const {
  return rotation_of(step.head<3>()) * arm_mm - arm_mm + step.tail<3>();
}

StepJacobian Carrier::jacobian(const SegmentStep& step) const {
  StepJacobian j;
  j.leftCols<3>() = -cross_matrix(rotation_of(step.head<3>()) * arm_mm) * left_jacobian(step.head<3>());
  j.rightCols<3>().setIdentity();
  return j;
}

Eigen::Vector2d CarriedCost::residual(const std::array<SegmentStep, 2>& steps) const {
  Eigen::Vector3d apart_mm = gap_mm;
  for (std::size_t i = 0; i < static_cast<std::size_t>(carrier_count); ++i)
    apart_mm += carriers[i].weight * carriers[i].moved_mm(steps[i]);
  return directions * apart_mm;
}

Eigen::Matrix<double, 2, 6> CarriedCost::jacobian(const std::array<SegmentStep, 2>& steps,
                                                  std::size_t of) const {
  return carriers[of].weight * directions * carriers[of].jacobian(steps[of]);
}

Eigen::Matrix<double, 6, 1> SeamCost::residual(const std::array<SegmentStep, 2>& steps) const {
  const Eigen::Vector3d apart_mm = gap_mm + sides[0].moved_mm(steps[0]) - sides[1].moved_mm(steps[1]);
  const Eigen::Matrix3d first = rotation_of(steps[0].head<3>()) * rotations_scan_from_cad[0];
  const Eigen::Matrix3d second = rotation_of(steps[1].head<3>()) * rotations_scan_from_cad[1];
  Eigen::Matrix<double, 6, 1> r;
  r << place_rows * apart_mm, turn_rows * turn_of(first.transpose() * second);
  return r;
}

Eigen::Matrix<double, 6, 6> SeamCost::jacobian(const std::array<SegmentStep, 2>& steps,
                                               std::size_t of) const {
  const Eigen::Matrix3d first = rotation_of(steps[0].head<3>()) * rotations_scan_from_cad[0];
  const Eigen::Matrix3d second = rotation_of(steps[1].head<3>()) * rotations_scan_from_cad[1];
  const double sign = of == 0 ? 1.0 : -1.0;
  Eigen::Matrix<double, 6, 6> j = Eigen::Matrix<double, 6, 6>::Zero();
  j.topRows<3>() = sign * place_rows * sides[of].jacobian(steps[of]);
  j.bottomLeftCorner<3, 3>() = -sign * turn_rows *
                               right_jacobian_inverse(turn_of(first.transpose() * second)) *
                               second.transpose() * left_jacobian(steps[of].head<3>());
  return j;
}

SegmentStep AnchorCost::residual(const SegmentStep& step) const {
  SegmentStep r;
  r << step.head<3>() / turn_sd_rad, shift_rows * (offset_mm + step.tail<3>());
  return r;
}

Eigen::Matrix<double, 6, 6> AnchorCost::jacobian() const {
  Eigen::Matrix<double, 6, 6> j = Eigen::Matrix<double, 6, 6>::Zero();
  j.topLeftCorner<3, 3>().diagonal().setConstant(1.0 / turn_sd_rad);
  j.bottomRightCorner<3, 3>() = shift_rows;
  return j;
}

std::array<double, 3> geman_mcclure(double squared, double scale) {
  const double c2 = scale * scale, ratio = c2 / (c2 + squared);
  return {ratio * squared, ratio * ratio, -2.0 * ratio * ratio / (c2 + squared)};
}

}  // namespace arris
