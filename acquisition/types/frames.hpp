#pragma once

#include <Eigen/Geometry>

namespace arris {

/// A rigid motion named to_from: p_scan = scan_from_cad * p_cad. Translation in mm.
using RigidMotion = Eigen::Isometry3d;

/// Angle of the rotation that carries one motion onto the other; rad, in [0, pi].
[[nodiscard]] inline double rotation_between_rad(const RigidMotion& a, const RigidMotion& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// A right-handed frame whose z axis is `axis` (unit); the other two are chosen by a fixed rule.
[[nodiscard]] inline Eigen::Matrix3d frame_with_z(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d helper =
      std::abs(axis.x()) < 0.8 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix3d frame;
  frame.col(2) = axis;
  frame.col(0) = (helper - helper.dot(axis) * axis).normalized();
  frame.col(1) = axis.cross(frame.col(0));
  return frame;
}

}  // namespace arris
