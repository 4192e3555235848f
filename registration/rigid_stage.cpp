#include "registration/rigid_stage.hpp"

#include <algorithm>
#include <utility>

namespace arris {
namespace {

constexpr double kStartLooseness = 8.0;
// A rigid motion leaves the bending: with a dense scan's reach and noise, points of the bent stretches were
// no part of the surface, and a third of the edge was not seen.
constexpr double kStartHeightReachMm = 10.0;
constexpr double kStartGateMm = 0.2;
constexpr int kSurfacePoints = 500;  // the surface counts as 100 points, however many there are

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

/// The edge by support relative to one rigid motion.
std::vector<ContourResult> edges_from_rigid(const CadModel& cad, const ScanModel& scan,
                                            const RigidMotion& rigid, const EdgeFitOptions& options) {
  std::vector<ContourMotion> motions;
  for (const Curve& curve : cad.contours) motions.push_back(rigid_motion(curve, rigid));
  return with_edges(cad, scan, std::move(motions), for_rigid_start(options));
}

/// What the edge fit itself does not know of the edge across, smooth along it, moves the pose as a whole: the
/// misfit that is left does not show it. Pose = inverse * sum(rows) * coefficients, so their covariance
/// carries over.
void add_edge_covariance(const CadModel& cad, const std::vector<ContourResult>& contours,
                         RigidIcpResult& rigid) {
  double reach_mm = 1.0;
  for (const Curve& curve : cad.contours) reach_mm = std::max(reach_mm, curve.length_mm() / 6.28);
  const Eigen::Matrix<double, 6, 6> inverse = determined(rigid.information, reach_mm).inverse;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    const EdgeFit& edge = contours[c].edge;
    Eigen::Matrix<double, 6, Eigen::Dynamic> pull =
        Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, edge.spline.size());
    along(cad.contours[c], [&](double s_mm) {
      if (!edge.seen_at(s_mm)) return;
      const Eigen::Vector3d across = cad.inward(c, s_mm);
      Eigen::Matrix<double, 6, 1> row;
      row << (cad.contours[c].point_mm(s_mm) - rigid.pivot_mm).cross(across), across;
      const SplineRow at = edge.spline.at(s_mm);
      for (std::size_t k = 0; k < 4; ++k) pull.col(at.index[k]) += at.value[k] * row;
    });
    const Eigen::Matrix<double, 6, Eigen::Dynamic> gain = inverse * pull;
    rigid.covariance += gain * edge.across_covariance * gain.transpose();
  }
}

}  // namespace

std::vector<ContourResult> rigid_stage(const CadModel& cad, ScanModel& scan,
                                       const RegistrationOptions& options, Registration& result) {
  RigidIcpOptions icp = options.rigid;
  icp.surface_points = std::min(icp.surface_points, kSurfacePoints);
  icp.start_scale_mm = std::max(3.0 * result.coarse.score_mm, 4.0 * scan.spacing_mm);
  result.rigid = icp_point_to_plane(cad, scan, result.coarse.scan_from_cad, icp);
  if (!result.rigid.usable()) return {};
  std::vector<ContourResult> edges = edges_from_rigid(cad, scan, result.rigid.scan_from_cad, options.edge);
  std::vector<Eigen::Vector3d> extracted = std::exchange(scan.edge_mm, sharpened(cad, scan, edges).points_mm);
  icp.start_scale_mm = 4.0 * scan.spacing_mm;
  icp.with_covariance = true;
  RigidIcpResult refined = icp_point_to_plane(cad, scan, result.rigid.scan_from_cad, icp);
  scan.edge_mm = std::move(extracted);
  if (!refined.usable()) return edges;
  add_edge_covariance(cad, edges, refined);
  result.rigid = std::move(refined);
  if (options.method == RegistrationMethod::kSurface) return {};  // it finds its own, relative to its field
  return edges_from_rigid(cad, scan, result.rigid.scan_from_cad, options.edge);
}

}  // namespace arris
