#include "registration/support_fit.hpp"

#include <utility>

namespace arris {
namespace {

constexpr double kStartLooseness = 8.0;
// A rigid motion leaves the bending: with a dense scan's reach and noise, points of the bent stretches were
// no part of the surface, and a third of the edge was not seen.
constexpr double kStartHeightReachMm = 10.0;
constexpr double kStartGateMm = 0.2;
constexpr double kScaleSpacings = 4.0;  // robust scale at the start

/// Looser splines and wider gates: relative to the rigid motion they carry the whole deformation.
EdgeFitOptions for_rigid_start(EdgeFitOptions options) {
  options.bend_across_per_mm *= kStartLooseness;
  options.bend_normal_per_mm *= kStartLooseness;
  options.tilt_change_rad *= kStartLooseness;
  options.gate_floor_mm = kStartGateMm;
  options.height_reach_mm = kStartHeightReachMm;
  return options;
}

ContourMotion rigid_motion(const Curve& curve, const RigidMotion& scan_from_cad) {
  SegmentFit fit;
  fit.scan_from_cad = scan_from_cad;
  SubdivisionOptions whole;
  whole.segment_length_max_mm = 10.0 * curve.length_mm();
  whole.corner_radius_max_mm = 0.0;
  const Subdivision subdivision(curve, whole);
  return {curve, subdivision, std::vector<SegmentFit>(subdivision.segments().size(), fit)};
}

}  // namespace

std::vector<ContourResult> edges_from_rigid(const CadModel& cad, const ScanModel& scan,
                                            const RigidMotion& scan_from_cad, const EdgeFitOptions& options) {
  std::vector<ContourMotion> motions;
  for (const Curve& curve : cad.contours) motions.push_back(rigid_motion(curve, scan_from_cad));
  return with_edges(cad, scan, std::move(motions), for_rigid_start(options));
}

SupportFit fit_to_support(const CadModel& cad, const ScanModel& scan, const RigidMotion& start,
                          const EdgeFitOptions& edge, RigidIcpOptions icp) {
  icp.start_scale_mm = kScaleSpacings * scan.spacing_mm;
  std::vector<ContourResult> edges = edges_from_rigid(cad, scan, start, edge);
  RigidIcpResult rigid = icp_point_to_plane(cad, scan, sharpened(cad, scan, edges).points_mm, start, icp);
  return {std::move(rigid), std::move(edges)};
}

}  // namespace arris
