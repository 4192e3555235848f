#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "acquisition/geometry/nearest.hpp"

namespace arris {

/// Gives neighbouring normals the same sign along the flattest ways through the cloud (minimum spanning tree
/// of 1 - |n . m| over the k nearest; Hoppe et al., SIGGRAPH 1992). Which of the two sides is out stays
/// unknown. Separate pieces of the cloud are joined by the sign of their first point. Cost O(N k log N), one
/// thread.
void orient_consistently(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree, int k,
                         std::vector<Eigen::Vector3d>& normals);

}  // namespace arris
