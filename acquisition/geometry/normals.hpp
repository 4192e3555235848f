#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "acquisition/geometry/nearest.hpp"

namespace arris {

/// The plane through each point's neighbourhood.
struct LocalPlanes {
  std::vector<Eigen::Vector3d> normals;  ///< unit, sign arbitrary until oriented
  std::vector<double> spacing_mm;  ///< local point spacing: sqrt(pi r_k^2 / k), r_k distance to neighbour k
  double noise_sigma_mm = 0.0;     ///< robust (MAD) residual of points to their plane, normal direction
  double spacing_median_mm = 0.0;
};

/// PCA normals over each point and its k nearest others (k >= 3; `tree` holds the same points). Residuals are
/// scaled by the share of its own noise that a point's plane absorbs, so that noise_sigma_mm does not depend
/// on k; a surface of radius R adds about r_k^2 / (4 R) to it. Clouds of fewer than 3 points get UnitZ. Cost
/// O(N k log N); same bytes for any thread count.
[[nodiscard]] LocalPlanes fit_local_planes(std::span<const Eigen::Vector3d> points_mm,
                                           const NearestPoints& tree, int k, int threads);

/// Turns each normal towards `seen_from_mm` (a point on the air side, same frame).
void orient_towards(std::span<const Eigen::Vector3d> points_mm, const Eigen::Vector3d& seen_from_mm,
                    std::vector<Eigen::Vector3d>& normals);

}  // namespace arris
