#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "acquisition/types/point_cloud.hpp"

namespace arris {

/// Options of clean(); every field is a recipe key of [scan].
struct CleanOptions {
  /// A stray's mean distance to its 8 neighbours is beyond the cloud's mean + this many standard deviations,
  /// and twice what its neighbours have themselves (or six times the cloud's median); rims and sparser
  /// regions are spared. 0: off
  double outlier_sigmas = 4.0;
  double voxel_mm = 0.0;  ///< one point (the one nearest the centroid, never an average) a voxel; 0: off
  int threads = 0;
};

/// What clean() kept; the reasons are printed in the report's header.
struct Cleaned {
  PointCloud cloud;
  std::vector<std::int32_t> kept;  ///< index in the input of each point of cloud
  std::size_t dropped_outliers = 0;
  std::size_t dropped_by_voxel = 0;
};

/// Statistical outliers, then voxel thinning. A voxel mean would pull a curved surface inwards, so a measured
/// point is kept instead. Throws Error(kInput) for an empty cloud, Error(kRecipe) for negative options. Cost
/// O(N log N); deterministic.
[[nodiscard]] Cleaned clean(const PointCloud& cloud, const CleanOptions& options);

/// Points within distance_mm of the polyline points given (same local frame as cloud.points_mm); kept order.
[[nodiscard]] PointCloud crop_to_band(const PointCloud& cloud,
                                      const std::vector<Eigen::Vector3d>& contour_local_mm,
                                      double distance_mm);

}  // namespace arris
