#pragma once

#include <Eigen/Core>
#include <vector>

#include "registration/edge_support.hpp"
#include "registration/surface_system.hpp"

namespace arris {

/// Standard deviation of an edge of a part about its own line: no cut is sharper.
inline constexpr double kEdgeBlurMm = 0.03;

/// What one scan point says of its edge, as a Gaussian: it costs precision / 2 g^2 - pull g when it lies g
/// inside.
struct EdgeMessage {
  double precision_per_mm2 = 0.0, pull_per_mm = 0.0;
  [[nodiscard]] double slope_at(double inside_mm) const {
    return precision_per_mm2 * inside_mm - pull_per_mm;
  }
};

/// A scan point near enough to an edge to bound it.
struct EdgeSite {
  std::size_t pair = 0;
  SurfaceSystem::Row row;  ///< derivative of inside_mm by the system's unknowns
  double inside_mm = 0.0;  ///< at the fit as it stands
  EdgeMessage message;
  WallPoints wall;  ///< it may be one of these
};

/// Posterior mean and covariance instead of the mode for one-sided edges, by expectation propagation. The
/// mode of a hard edge touches the outermost points and lies up to the edge limit beside the mean, and its
/// curvature does not know how far the edge may still be. Each point bounds its edge, but for a blur and for
/// a share of strays and of points on the cut's wall; here the bound's message is renewed until it gives the
/// mean and variance of the point's g that the bound itself gives beside all the others' messages.
///   fit      normal equations at the fit as it stands, the sites' messages in them
///   sites    their messages are renewed
///   cost     O(unknowns^2 * sites + sweeps * sites^3)
///   source   Minka, UAI 2001; Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, section
///            3.6, here about a fit that has messages already, so that nothing cancels
void pass_messages(const SurfaceSystem& fit, double stray_ratio, std::vector<EdgeSite>& sites);

}  // namespace arris
