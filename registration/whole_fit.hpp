#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "acquisition/geometry/surface_query.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// Options of fit_whole().
struct WholeFitOptions {
  double start_scale_mm = 20.0;  ///< robust scale at the start: about the error of the start pose
  int few_points = 1500;         ///< until the step is small
  int many_points = 20000;       ///< from there on, and more where the surface holds the part badly:
  double wanted_sd_mm = 0.005;   ///< as many as bring the pose's standard deviation down to this
  int threads = 0;
};

/// The rigid motion that lays a whole scan on the drawing's surface; read it only if usable().
struct WholeFit {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  double rms_mm = 0.0;         ///< of the points fitted last, point to plane, weighted
  double sd_mm = 0.0;          ///< of the motion along what is held worst, from the scatter of the residuals
  double partner_ratio = 0.0;  ///< share of them that found a place on the surface
  std::size_t points = 0;      ///< fitted last
  int rounds = 0;
  std::vector<std::string> free_directions;  ///< motions that the surface leaves free: not moved along
  std::string reason;                        ///< why there is no result; empty when usable
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// Best fit of all points to the surface, each against the triangles themselves: few points first, drawn
/// evenly from the whole scan, then more, by Gauss-Newton with annealed Geman-McClure weights. Feet on the
/// border of an open drawing do not count.
///   points_mm  frame Scan about the cloud's offset, any order; finite
///   start      off by a few times start_scale_mm at most
///   refuses    fewer than 6 points, or less than a tenth of them, on the surface; a fit that does not settle
///   cost       some 15 rounds of few and 5 of many points, however many there are, unless the surface is so
///              smooth that it holds a motion badly; the same bytes for any thread count
[[nodiscard]] WholeFit fit_whole(const SurfaceQuery& cad, std::span<const Eigen::Vector3f> points_mm,
                                 const RigidMotion& start_scan_from_cad, const WholeFitOptions& options);

}  // namespace arris
