#pragma once

#include <Eigen/Core>
#include <span>

#include "acquisition/types/frames.hpp"

namespace arris::bench {

// The peer: PCL's rigid registration, from a start pose, stopping when a round changes nothing.

/// pcl::IterativeClosestPoint: model points (CAD) to their nearest data points (scan), at most 200 rounds.
/// Returns scan_from_cad.
[[nodiscard]] RigidMotion pcl_point_to_point(std::span<const Eigen::Vector3d> model_mm,
                                             std::span<const Eigen::Vector3d> data_mm,
                                             const RigidMotion& start_scan_from_cad);

/// pcl::IterativeClosestPointWithNormals: the same to the planes of the data points; pairs farther apart than
/// reach_mm are left out.
[[nodiscard]] RigidMotion pcl_point_to_plane(std::span<const Eigen::Vector3d> model_mm,
                                             std::span<const Eigen::Vector3d> data_mm,
                                             std::span<const Eigen::Vector3d> data_normals,
                                             const RigidMotion& start_scan_from_cad, double reach_mm,
                                             int most_rounds = 50);

}  // namespace arris::bench
