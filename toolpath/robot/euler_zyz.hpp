#pragma once

#include <Eigen/Core>

namespace arris {

/// Yaw, pitch and roll in degrees: turn = Rz(yaw) Ry(pitch) Rz(roll), as V+ takes them (ZYZ'). Each is
/// rounded to `decimals`, in (-180, 180], pitch in [0, 180]; the roll makes up for what the rounding of the
/// others left. Where the rounded pitch is 0 or 180 only yaw + roll or yaw - roll is defined: roll is 0
/// there. The angles turn within 2 roundings of `turn`, which must be a rotation.
[[nodiscard]] Eigen::Vector3d yaw_pitch_roll_deg(const Eigen::Matrix3d& turn, int decimals);

}  // namespace arris
