#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/geometry/nearest.hpp"

namespace arris {

/// What counts as a seen sphere.
struct SphereOptions {
  double radius_tolerance_ratio = 0.02;  ///< the radius that the points have themselves may differ by this
  double noise_most_ratio = 0.02;        ///< scatter about the sphere over its radius; more is no sphere
  int fewest_points = 20;                ///< on the sphere
  int threads = 0;
  void check() const;  ///< throws Error(kBug)
};

/// A sphere of known radius, as the scan shows it; frame and unit of the points.
struct FoundSphere {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();  ///< of the centre, white noise assumed
  double noise_sigma_mm = 0.0;                               ///< scatter of the points about the sphere
  double own_radius_mm = 0.0;                                ///< with the radius left free
  std::vector<std::int32_t> points;                          ///< that the centre was fitted to, ascending
};

/// A set of scan points to look for spheres in; keeps a tree over them.
class SphereFinder {
 public:
  /// Build O(N log N). Throws Error(kBug) for bad options or a point that is not finite.
  SphereFinder(std::span<const Eigen::Vector3d> points_mm, const SphereOptions& options);

  /// All spheres of one radius, best supported first, at most 60. Points vote for the centres that their
  /// normals point at (either side), peaks are fitted by least squares with the known radius about points
  /// within four standard deviations. A peak is no sphere when
  ///   - its points are few, scatter, or do not have the sphere's normals
  ///   - what is seen does not fix the centre: less than a cap of about 24 degrees, or a band of a cylinder
  ///   - points lie inside it, or they have another radius of their own
  /// Cost O(N log N), of a dense scan mostly that of thinning it to a tenth of the radius.
  [[nodiscard]] std::vector<FoundSphere> find(double radius_mm) const;

  /// Points within `reach_mm` of a place, ascending.
  [[nodiscard]] std::vector<std::int32_t> points_near(const Eigen::Vector3d& place_mm, double reach_mm) const;

 private:
  std::vector<Eigen::Vector3d> points_mm_;
  NearestPoints tree_;
  SphereOptions options_;
};

}  // namespace arris
