#include "registration/registration.hpp"

#include <algorithm>

#include "registration/found_edge.hpp"
#include "registration/judge.hpp"
#include "registration/rigid_stage.hpp"
#include "registration/strain.hpp"
#include "registration/surface_stage.hpp"

namespace arris {
namespace {

constexpr int kSharpeningPasses = 2;
constexpr double kLoopReachRatio = 0.6;  // of the band: bending, and what the start pose is off by
constexpr double kLoopReachScores = 3.0, kLoopReachSpacings = 2.0;  // nor farther than the pose leaves it
constexpr double kBesideStockMm = 3.0;  // role cut: edges this near to the stock's are no data

/// Turns an undecided scan to the side that the start pose chose.
void flip(ScanModel& scan) {
  for (auto* list : {&scan.normals, &scan.edge_normals})
    for (Eigen::Vector3d& n : *list) n = -n;
  for (Contour& loop : scan.loops) {
    for (Eigen::Vector3d& n : loop.normals) n = -n;
    std::reverse(loop.points_mm.begin(), loop.points_mm.end());
    std::reverse(loop.normals.begin(), loop.normals.end());
  }
}

/// Keeps the edge points of the loops that run along an accepted contour, and of those loops what is near it:
/// a gap may join it to the border of the scan. The rest is told, not used.
///   returns  the contours along which runs a loop that the operator rejected, and none that was accepted
std::vector<std::size_t> drop_other_loops(const CadModel& cad, ScanModel& scan,
                                          const RigidMotion& scan_from_cad, double band_mm, double near_mm,
                                          std::vector<LoopAssignment>& assigned) {
  assigned = assign_loops(cad, scan.loops, scan_from_cad, band_mm);
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  scan.edge_mm.clear();
  scan.edge_normals.clear();
  std::vector<char> rejected(cad.contours.size(), 0), accepted(cad.contours.size(), 0);
  for (std::size_t l = 0; l < scan.loops.size(); ++l) {
    if (assigned[l].contour < 0) continue;
    const std::size_t contour = static_cast<std::size_t>(assigned[l].contour);
    (scan.is_rejected(l) ? rejected : accepted)[contour] = 1;
    if (scan.is_rejected(l)) {
      assigned[l].contour = -1;
      continue;
    }
    for (std::size_t i = 0; i < scan.loops[l].points_mm.size(); ++i) {
      if (!near_contours(cad, cad_from_scan * scan.loops[l].points_mm[i], near_mm)) continue;
      scan.edge_mm.push_back(scan.loops[l].points_mm[i]);
      scan.edge_normals.push_back(scan.loops[l].normals[i]);
    }
  }
  std::vector<std::size_t> only_rejected;
  for (std::size_t c = 0; c < rejected.size(); ++c)
    if (rejected[c] && !accepted[c]) only_rejected.push_back(c);
  return only_rejected;
}

std::string rejected_by_operator(const Curve& curve) {
  return "contour " + std::to_string(curve.contour().id) +
         ": the operator rejected the scan's loop along it; scan it again, or accept that loop";
}

/// Role cut: what the tool is still to make, and stock that stands there, is no data.
void drop_edges_at(const std::vector<Curve>& cut, const RigidMotion& scan_from_cad, double within_mm,
                   ScanModel& scan) {
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scan.edge_mm.size(); ++i) {
    const Eigen::Vector3d p_cad_mm = cad_from_scan * scan.edge_mm[i];
    const bool at_cut = std::any_of(cut.begin(), cut.end(), [&](const Curve& curve) {
      return curve.nearest(p_cad_mm).distance_mm <= within_mm;
    });
    if (at_cut) continue;
    scan.edge_mm[kept] = scan.edge_mm[i];
    scan.edge_normals[kept++] = scan.edge_normals[i];
  }
  scan.edge_mm.resize(kept);
  scan.edge_normals.resize(kept);
}

/// Role cut: the pose comes from the drawing's other contours, for the accepted ones are not on the part yet.
CadModel posed_by_others(const CadModel& cad) {
  CadModel posed = cad;
  posed.contours = cad.others;
  posed.others.clear();
  return posed;
}

void deform_by_projection(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
                          Registration& result) {
  const RigidMotion& rigid = result.rigid.scan_from_cad;
  for (std::size_t c = 0; c < cad.contours.size(); ++c)
    result.projection.push_back(
        project_contour(cad, c, scan, rigid, result.contours[c].edge, options.projection));
  result.field = std::make_shared<ProjectionField>(cad, rigid, result.projection, options.band_mm);
}

void deform_by_subdivision(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
                           Registration& result) {
  std::vector<ContourMotion> earlier;
  for (int pass = 0; pass < kSharpeningPasses; ++pass) {
    const EdgeData edge = sharpened(cad, scan, result.contours);
    std::vector<ContourMotion> moved =
        subdivision_icp(cad, scan, edge, result.rigid.scan_from_cad, options.subdivision, earlier);
    earlier = moved;
    result.contours = with_edges(cad, scan, std::move(moved), options.edge);
  }
  if (options.refine == RefineMethod::kCeres) {
    EdgeData edge = sharpened(cad, scan, result.contours);
    edge.correlated_ratio = std::max(1.0, options.edge.knot_mm / kContourStepMm);
    result.refinement = refine_segments(cad, scan, edge, earlier, options.subdivision, {});
    result.contours = with_edges(cad, scan, result.refinement.motions, options.edge);
  }
  result.field = std::make_shared<SubdivisionField>(cad, result.contours, options.band_mm,
                                                    options.role == ContourRole::kEdge);
}

/// From the edges relative to the rigid motion, the field of the method.
void deform(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
            Registration& result) {
  switch (options.method) {
    case RegistrationMethod::kRigid:
      result.field = std::make_shared<RigidField>(result.rigid.scan_from_cad);
      return;
    case RegistrationMethod::kProjection:
      return deform_by_projection(cad, scan, options, result);
    case RegistrationMethod::kSubdivision:
      return deform_by_subdivision(cad, scan, options, result);
    case RegistrationMethod::kSurface:
      return deform_by_surface(cad, scan, options, result);
  }
}

}  // namespace

Registration register_part(const CadModel& cad, ScanModel& scan, const RegistrationOptions& options) {
  Registration result;
  const bool cut = options.role == ContourRole::kCut;
  if (cut && cad.others.empty()) {
    result.refusals.emplace_back(
        "role cut: the drawing has no other contour (outline, datum hole) that could tell where the part "
        "lies");
    return result;
  }
  const std::optional<CadModel> by_others = cut ? std::optional(posed_by_others(cad)) : std::nullopt;
  const CadModel& posed = cut ? *by_others : cad;
  CoarseAlignOptions coarse = options.coarse;
  if (coarse.path.empty())  // not round what holds the part, when it is to be cut
    for (const Curve& curve : cad.contours) coarse.path.push_back(curve.contour());
  coarse.edges_needed = !cut;  // what holds the part is judged at the end, by the field's covariance
  result.coarse = coarse_align(posed, scan, coarse);
  if (!result.coarse.usable()) {
    result.refusals.push_back(result.coarse.reason);
    return result;
  }
  if (result.coarse.flipped_normals) flip(scan);
  scan.side = SideKnown::kYes;
  const PoseWatch watch(posed, scan, options.coarse.band_mm, result.coarse.score_mm);
  const double near_mm =
      std::min(kLoopReachRatio * options.coarse.band_mm,
               kLoopReachScores * result.coarse.score_mm + kLoopReachSpacings * scan.spacing_mm);
  for (const std::size_t c : drop_other_loops(posed, scan, result.coarse.scan_from_cad,
                                              options.coarse.band_mm, near_mm, result.loops))
    result.refusals.push_back(rejected_by_operator(posed.contours[c]));
  if (!result.refusals.empty()) return result;
  if (cut)
    drop_edges_at(cad.contours, result.coarse.scan_from_cad, options.surface.stock_mm + kBesideStockMm, scan);
  result.contours = rigid_stage(posed, scan, options, watch, result);
  if (!result.rigid.usable()) {
    result.refusals.push_back(result.rigid.reason);
    return result;
  }
  double size_mm = 1.0;
  for (const Curve& curve : posed.contours) size_mm = std::max(size_mm, curve.length_mm() / 6.28);
  result.free_directions = free_directions(result.rigid.information, result.rigid.pivot_mm, size_mm);
  if (cut) result.contours.clear();  // those of the other contours
  deform(cad, scan, options, result);
  if (!result.usable()) return result;
  measure_strain(cad, options, result);
  judge_strain(result);
  if (cut) {
    result.density_per_mm2 = 1.0 / (scan.spacing_mm * scan.spacing_mm);
    return result;
  }
  const RigidMotion& pose = result.rigid.scan_from_cad;
  result.stage_residual_mm.emplace_back(
      "rigid", edge_rms_mm(cad, result.contours,
                           [&](std::size_t, double, const Eigen::Vector3d& p) { return pose * p; }));
  const auto carried = [&](std::size_t c, double s_mm, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    if (options.method == RegistrationMethod::kProjection) return result.field->map(p).p_scan_mm;
    return result.contours[c].motion.at(s_mm) * p;  // the material, without the edge's own error
  };
  if (options.method != RegistrationMethod::kRigid)
    result.stage_residual_mm.emplace_back(
        result.refinement.usable() ? "subdivision, refined" : result.field->method(),
        edge_rms_mm(cad, result.contours, carried));
  for (const ContourResult& contour : result.contours)
    result.density_per_mm2 = std::max(result.density_per_mm2, contour.edge.density_per_mm2);
  result.seen_ratio = seen_ratio(result.contours);
  judge_coverage(cad, options, result);
  if (options.method == RegistrationMethod::kSubdivision) judge_seams(cad, result);
  if (options.method == RegistrationMethod::kProjection) judge_projection(cad, options.projection, result);
  if (options.method != RegistrationMethod::kRigid) {
    judge_residuals(cad, scan, result);
    judge_moved(cad, watch, result);
  }
  return result;
}

double rigid_gap_mm(const CadModel& cad, std::size_t contour, const Registration& registration,
                    double arc_mm) {
  const ContourResult& found = registration.contours[contour];
  const Eigen::Vector3d edge_mm = edge_point_mm(cad, contour, found.motion, found.edge, arc_mm);
  return cad.contours[contour].nearest(registration.rigid.scan_from_cad.inverse() * edge_mm).distance_mm;
}

double height_gap_mm(std::size_t contour, const Registration& registration, double arc_mm) {
  const ContourResult& found = registration.contours[contour];
  const double height_mm = found.edge.spline.at(arc_mm).dot(found.edge.height);
  if (registration.projection.empty()) return height_mm;
  const ProjectionModel& model = registration.projection[contour].fit.model;
  return height_mm - contour_height(found.motion.nominal(), model, arc_mm).mm;
}

}  // namespace arris
