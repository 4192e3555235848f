#pragma once

#include <Eigen/Core>
#include <string>

#include "acquisition/types/frames.hpp"

namespace arris {

/// A location with the digits that a V+ program has of it, 4 decimals each: what the controller works with.
struct VplusLocation {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_deg = Eigen::Vector3d::Zero();  ///< yaw, pitch, roll
};

/// The location that a pose is written as.
[[nodiscard]] VplusLocation vplus_location(const RigidMotion& motion);

/// TRANS(x, y, z, yaw, pitch, roll); throws Error(kBug) for what is not finite.
[[nodiscard]] std::string trans_text(const VplusLocation& location);

/// A length with 4 decimals, mm.
[[nodiscard]] std::string vplus_length_text(double length_mm);

/// Whether the controller comes to `pose` when it goes back from `row` along the tool's own z, as APPRO and
/// DEPART do: the same three angles, and the place within 0.0005 mm, half of what a program may be off. The
/// digits of the row's angles count here: their rounding grows with the distance.
///   back_mm   as it is written, vplus_length_text
[[nodiscard]] bool lies_back(const RigidMotion& pose, const RigidMotion& row, double back_mm);

}  // namespace arris
