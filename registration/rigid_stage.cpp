#include "registration/rigid_stage.hpp"

#include <algorithm>
#include <utility>

#include "registration/support_fit.hpp"

namespace arris {
namespace {

constexpr int kSurfacePoints = 500;  // the surface counts as 100 points, however many there are
constexpr int kSupportRounds = 2;    // from the pose as found, where extracted points led astray

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

/// The best, by the watch, of a fit that extracted points led and of those that the edge by support makes of
/// the pose found, in turn; where all are led astray the pose stays where it was found.
SupportFit best_by_watch(const CadModel& cad, const ScanModel& scan, const RigidMotion& found,
                         const EdgeFitOptions& edge, const RigidIcpOptions& icp, const PoseWatch& watch,
                         SupportFit led) {
  SupportFit best, last;
  double least = kAstrayRatio;
  const auto offer = [&](SupportFit fit) {
    const double worse = watch.times_worse(fit.rigid.scan_from_cad);
    if (worse <= least) best = fit;
    least = std::min(least, worse);
    last = std::move(fit);
  };
  offer(std::move(led));
  RigidMotion start = found;
  for (int round = 0; round < kSupportRounds; ++round) {
    SupportFit fit = fit_to_support(cad, scan, start, edge, icp);
    if (!fit.rigid.usable()) break;
    start = fit.rigid.scan_from_cad;
    offer(std::move(fit));
  }
  if (!best.edges.empty()) return best;
  last.rigid.scan_from_cad = found;
  return last;
}

}  // namespace

std::vector<ContourResult> rigid_stage(const CadModel& cad, const ScanModel& scan,
                                       const RegistrationOptions& options, const PoseWatch& watch,
                                       Registration& result) {
  const RigidMotion& found = result.coarse.scan_from_cad;
  RigidIcpOptions icp = options.rigid;
  icp.surface_points = std::min(icp.surface_points, kSurfacePoints);
  icp.start_scale_mm = std::max(3.0 * result.coarse.score_mm, 4.0 * scan.spacing_mm);
  result.rigid = icp_point_to_plane(cad, scan, found, icp);
  if (!result.rigid.usable()) return {};
  icp.with_covariance = true;
  SupportFit fit = fit_to_support(cad, scan, result.rigid.scan_from_cad, options.edge, icp);
  if (!fit.rigid.usable()) return std::move(fit.edges);
  const double worse = watch.times_worse(fit.rigid.scan_from_cad);
  if (worse > kAstrayRatio || (worse > 1.0 && watch.times_worse(result.rigid.scan_from_cad) > kAstrayRatio))
    fit = best_by_watch(cad, scan, found, options.edge, icp, watch, std::move(fit));
  add_edge_covariance(cad, fit.edges, fit.rigid);
  result.rigid = std::move(fit.rigid);
  if (options.method == RegistrationMethod::kSurface) return {};  // it finds its own, relative to its field
  return edges_from_rigid(cad, scan, result.rigid.scan_from_cad, options.edge);
}

}  // namespace arris
