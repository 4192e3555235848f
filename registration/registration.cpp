#include "registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "registration/edge_pairs.hpp"
#include "registration/seams.hpp"
#include "registration/surface_stage.hpp"

namespace arris {
namespace {

constexpr double kSharpenedSigmaRatio = 0.1;  // scatter of the edge by support, in spacings
constexpr int kSharpeningPasses = 2;
constexpr double kRigidStartLooseness = 8.0;
constexpr double kSampleMm = 2.0;
constexpr double kBesideStockMm = 3.0;  // role cut: edges this near to the stock's are no data
constexpr double kSeamMm = 2.5,
                 kSeamEdgeLimits = 3.0;    // how far segments may disagree: bending, and the edge limit
constexpr double kAcrossEdgeLimits = 2.0;  // an edge that seems to lie this far off may be the scan's grain
constexpr double kResidualMm = 0.15, kResidualSigmas = 5.0;  // of the height beside the edge

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

/// Keeps the edge points of the loops that run along an accepted contour; the rest is told, not used.
void drop_other_loops(const CadModel& cad, ScanModel& scan, const RigidMotion& scan_from_cad, double band_mm,
                      std::vector<LoopAssignment>& assigned) {
  assigned = assign_loops(cad, scan.loops, scan_from_cad, band_mm);
  scan.edge_mm.clear();
  scan.edge_normals.clear();
  for (std::size_t l = 0; l < scan.loops.size(); ++l) {
    if (l < scan.loop_rejected.size() && scan.loop_rejected[l]) assigned[l].contour = -1;
    if (assigned[l].contour < 0) continue;
    scan.edge_mm.insert(scan.edge_mm.end(), scan.loops[l].points_mm.begin(), scan.loops[l].points_mm.end());
    scan.edge_normals.insert(scan.edge_normals.end(), scan.loops[l].normals.begin(),
                             scan.loops[l].normals.end());
  }
}

template <class Body>
void along(const Curve& curve, const Body& body) {
  const int count = std::max(8, static_cast<int>(curve.length_mm() / kSampleMm));
  for (int i = 0; i < count; ++i) body(curve.length_mm() * i / count);
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

/// Looser splines: relative to the rigid motion they carry the whole deformation.
EdgeFitOptions for_rigid_start(EdgeFitOptions options) {
  options.bend_across_per_mm *= kRigidStartLooseness;
  options.bend_normal_per_mm *= kRigidStartLooseness;
  options.tilt_change_rad *= kRigidStartLooseness;
  return options;
}

/// The found edge, sampled where it was seen.
EdgeData sharpened(const CadModel& cad, const ScanModel& scan, const std::vector<ContourResult>& contours) {
  EdgeData data;
  data.sigma_across_mm = std::max(0.05, kSharpenedSigmaRatio * scan.spacing_mm);
  for (std::size_t c = 0; c < contours.size(); ++c)
    along(cad.contours[c], [&](double s_mm) {
      if (!contours[c].edge.seen_at(s_mm)) return;
      data.points_mm.push_back(edge_point_mm(cad, c, contours[c].motion, contours[c].edge, s_mm));
      data.contour.push_back(c);
      data.arc_mm.push_back(s_mm);
    });
  return data;
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

/// Rms distance from the found edge to the nominal carried by `carry`, over the seen part of all contours.
template <class Carry>
double edge_rms(const CadModel& cad, const std::vector<ContourResult>& contours, const Carry& carry) {
  double sum2 = 0.0, count = 0.0;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    Contour carried = cad.contours[c].contour();
    for (std::size_t i = 0; i < carried.points_mm.size(); ++i)
      carried.points_mm[i] =
          carry(c, cad.contours[c].arc_of_point_mm(static_cast<int>(i)), carried.points_mm[i]);
    const Curve image(carried);
    along(cad.contours[c], [&](double s_mm) {
      if (!contours[c].edge.seen_at(s_mm)) return;
      const double d =
          image.nearest(edge_point_mm(cad, c, contours[c].motion, contours[c].edge, s_mm)).distance_mm;
      sum2 += d * d;
      count += 1.0;
    });
  }
  return count > 0.0 ? std::sqrt(sum2 / count) : 0.0;
}

/// Lengthening of the contours at a depth below the face, by a field that does not follow the edge's own
/// error: a fibre of that depth is carried rigidly, so the face's strain less depth times change of
/// curvature.
double stretch(const CadModel& cad, const DeformationField& field, double depth_mm) {
  double carried_mm = 0.0, nominal_mm = 0.0;
  for (const Curve& curve : cad.contours) {
    Contour nominal, image;
    nominal.closed = image.closed = curve.closed();
    along(curve, [&](double s_mm) {
      const Eigen::Vector3d fibre_mm = -depth_mm * curve.normal(s_mm);
      const MappedPoint place = field.map(curve.point_mm(s_mm));
      nominal.points_mm.push_back(curve.point_mm(s_mm) + fibre_mm);
      image.points_mm.push_back(place.p_scan_mm + place.rotation_scan_from_cad * fibre_mm);
    });
    carried_mm += length_mm(image);
    nominal_mm += length_mm(nominal);
  }
  return nominal_mm > 0.0 ? carried_mm / nominal_mm - 1.0 : 0.0;
}

void measure_strain(const CadModel& cad, const RegistrationOptions& options, Registration& result) {
  if (options.method == RegistrationMethod::kRigid) return;  // it does not look for any
  // The surface field hardly stretches by its prior: a rim that is longer shows in the edge it follows.
  const std::shared_ptr<const DeformationField> shape =
      options.method == RegistrationMethod::kSurface
          ? result.field
          : std::make_shared<SubdivisionField>(cad, result.contours, options.band_mm, false);
  result.face_strain_ratio = stretch(cad, *shape, 0.0);
  result.mean_strain_ratio =
      options.mid_depth_mm > 0.0 ? stretch(cad, *shape, options.mid_depth_mm) : result.face_strain_ratio;
  if (options.role == ContourRole::kCut) return;  // no rim that could be longer than drawn
  double length = 0.0, limit_mm = 0.0;
  for (const ContourResult& contour : result.contours) {
    length += contour.motion.nominal().length_mm();
    limit_mm +=
        2.0 * std::numbers::pi * contour.edge.edge_limit_mm();  // a rim that wide all round is so much longer
  }
  result.strain_limit_ratio = length > 0.0 ? limit_mm / length : 0.0;
}

/// Longest run of bins without data, as arc lengths; wraps on a closed contour.
struct Unseen {
  double from_mm = 0.0, length_mm = 0.0;
};
Unseen longest_unseen(const EdgeFit& edge, bool closed) {
  Unseen longest;
  const std::size_t n = edge.seen.size();
  for (std::size_t start = 0; start < n; ++start) {
    if (edge.seen[start] || (start > 0 && !edge.seen[start - 1])) continue;
    std::size_t run = 0;
    while (run < n && (closed || start + run < n) && !edge.seen[(start + run) % n]) ++run;
    if (static_cast<double>(run) * edge.bin_mm > longest.length_mm)
      longest = {static_cast<double>(start) * edge.bin_mm, static_cast<double>(run) * edge.bin_mm};
  }
  return longest;
}

/// Where two neighbouring segments disagree about the place of their common cut, one of them is wrong.
void judge_seams(const CadModel& cad, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const ContourMotion& motion = result.contours[c].motion;
    const double edge_limit_mm = 1.0 / (50.0 * std::max(result.contours[c].edge.density_per_mm2, 1e-9));
    const double limit_mm = kSeamMm + kSeamEdgeLimits * edge_limit_mm;
    for (const Seam& seam : seams_of(motion)) {
      if (seam.jump_mm < limit_mm) continue;
      char text[200];
      std::snprintf(
          text, sizeof text,
          "contour %d: the segments on both sides of s = %.0f mm disagree by %.1f mm (at most %.1f)",
          cad.contours[c].contour().id, seam.arc_mm, seam.jump_mm, limit_mm);
      result.refusals.emplace_back(text);
    }
  }
}

/// Heights beside the edge that scatter far more than the scanner's noise are not explained by the field.
void judge_residuals(const CadModel& cad, const ScanModel& scan, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const double limit_mm = kResidualMm + kResidualSigmas * scan.noise_sigma_mm;
    if (result.contours[c].edge.residual_sigma_mm < limit_mm) continue;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "contour %d: the surface beside the edge is not explained: residual %.2f mm, scanner noise %.2f mm",
        cad.contours[c].contour().id, result.contours[c].edge.residual_sigma_mm, scan.noise_sigma_mm);
    result.refusals.emplace_back(text);
  }
}

/// Share of the contours' length on which the edge was seen.
double seen_ratio(const std::vector<ContourResult>& contours) {
  double seen = 0.0, length = 0.0;
  for (const ContourResult& contour : contours) {
    seen += contour.edge.seen_ratio() * contour.motion.nominal().length_mm();
    length += contour.motion.nominal().length_mm();
  }
  return length > 0.0 ? seen / length : 0.0;
}

void judge_coverage(const CadModel& cad, const RegistrationOptions& options, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const EdgeFit& edge = result.contours[c].edge;
    const int id = cad.contours[c].contour().id;
    char text[200];
    if (edge.seen_ratio() < options.min_seen_ratio) {
      std::snprintf(text, sizeof text, "contour %d: the scan shows %.0f %% of the edge, %.0f %% needed", id,
                    100.0 * edge.seen_ratio(), 100.0 * options.min_seen_ratio);
      result.refusals.emplace_back(text);
    }
    const Unseen gap = longest_unseen(edge, cad.contours[c].closed());
    if (gap.length_mm > options.max_unseen_mm) {
      std::snprintf(text, sizeof text, "contour %d not seen from s = %.0f to %.0f mm (%.0f mm, at most %.0f)",
                    id, gap.from_mm, gap.from_mm + gap.length_mm, gap.length_mm, options.max_unseen_mm);
      result.refusals.emplace_back(text);
    }
  }
}

/// What a projection leaves beyond its limit, on the surface and in it. Across the edge it is also allowed
/// what a scan of this density cannot show.
void judge_projection(const CadModel& cad, const ProjectionOptions& options, Registration& result) {
  for (std::size_t c = 0; c < result.projection.size(); ++c) {
    const ContourProjection& found = result.projection[c];
    const std::string contour = "contour " + std::to_string(cad.contours[c].contour().id) + ": ";
    const std::string model = word_of(options.kind);
    if (!found.fit.usable()) {
      result.refusals.push_back(contour + "no " + model + " can be fitted: " + found.fit.reason);
      continue;
    }
    char text[300];
    if (found.residual.height_rms_mm > options.max_residual_mm) {
      std::snprintf(text, sizeof text,
                    "the surface beside it is not bent as a %s: %.2f mm rms left (at most %.2f); "
                    "registration.projection.model = \"spline\" or method = \"subdivision\" can follow it",
                    model.c_str(), found.residual.height_rms_mm, options.max_residual_mm);
      result.refusals.push_back(contour + text);
    }
    const double limit_mm = options.max_residual_mm + kAcrossEdgeLimits * found.edge.edge_limit_mm();
    if (found.residual.across_rms_mm > limit_mm) {
      std::snprintf(text, sizeof text,
                    "the edge has moved in the surface, which no projection follows: %.2f mm rms (at most "
                    "%.2f); method = \"subdivision\" does",
                    found.residual.across_rms_mm, limit_mm);
      result.refusals.push_back(contour + text);
    }
  }
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
    edge.correlated_ratio = std::max(1.0, options.edge.knot_mm / kSampleMm);
    result.refinement = refine_segments(cad, scan, edge, earlier, options.subdivision, {});
    result.contours = with_edges(cad, scan, result.refinement.motions, options.edge);
  }
  result.field = std::make_shared<SubdivisionField>(cad, result.contours, options.band_mm,
                                                    options.role == ContourRole::kEdge);
}

/// The edge relative to the rigid motion, and from there the field of the method.
void deform(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
            Registration& result) {
  if (options.method == RegistrationMethod::kSurface) return deform_by_surface(cad, scan, options, result);
  const RigidMotion& rigid = result.rigid.scan_from_cad;
  std::vector<ContourMotion> motions;
  for (const Curve& curve : cad.contours) motions.push_back(rigid_motion(curve, rigid));
  result.contours = with_edges(cad, scan, std::move(motions), for_rigid_start(options.edge));
  switch (options.method) {
    case RegistrationMethod::kRigid:
      result.field = std::make_shared<RigidField>(rigid);
      return;
    case RegistrationMethod::kProjection:
      return deform_by_projection(cad, scan, options, result);
    case RegistrationMethod::kSubdivision:
      return deform_by_subdivision(cad, scan, options, result);
    case RegistrationMethod::kSurface:  // above: it needs no edge relative to the rigid motion
      return;
  }
}

}  // namespace

std::vector<ContourResult> with_edges(const CadModel& cad, const ScanModel& scan,
                                      std::vector<ContourMotion> motions, const EdgeFitOptions& options) {
  std::vector<ContourResult> results;
  for (std::size_t c = 0; c < motions.size(); ++c) {
    EdgeFit edge = fit_edge(cad, c, scan, motions[c], options);
    results.push_back({std::move(motions[c]), std::move(edge)});
  }
  return results;
}

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
  coarse.edges_needed = !cut;  // what holds the part is judged at the end, by the field's covariance
  result.coarse = coarse_align(posed, scan, coarse);
  if (!result.coarse.usable()) {
    result.refusals.push_back(result.coarse.reason);
    return result;
  }
  if (result.coarse.flipped_normals) flip(scan);
  scan.side = SideKnown::kYes;
  drop_other_loops(posed, scan, result.coarse.scan_from_cad, options.coarse.band_mm, result.loops);
  if (cut)
    drop_edges_at(cad.contours, result.coarse.scan_from_cad, options.surface.stock_mm + kBesideStockMm, scan);
  RigidIcpOptions rigid = options.rigid;
  rigid.start_scale_mm = std::max(3.0 * result.coarse.score_mm, 4.0 * scan.spacing_mm);
  result.rigid = icp_point_to_plane(posed, scan, result.coarse.scan_from_cad, rigid);
  if (!result.rigid.usable()) {
    result.refusals.push_back(result.rigid.reason);
    return result;
  }
  double size_mm = 1.0;
  for (const Curve& curve : posed.contours) size_mm = std::max(size_mm, curve.length_mm() / 6.28);
  result.free_directions = free_directions(result.rigid.information, result.rigid.pivot_mm, size_mm);
  deform(cad, scan, options, result);
  if (!result.usable()) return result;
  measure_strain(cad, options, result);
  if (cut) return result;
  const RigidMotion& pose = result.rigid.scan_from_cad;
  result.stage_residual_mm.emplace_back(
      "rigid", edge_rms(cad, result.contours,
                        [&](std::size_t, double, const Eigen::Vector3d& p) { return pose * p; }));
  const auto carried = [&](std::size_t c, double s_mm, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    if (options.method == RegistrationMethod::kProjection) return result.field->map(p).p_scan_mm;
    return result.contours[c].motion.at(s_mm) * p;  // the material, without the edge's own error
  };
  if (options.method != RegistrationMethod::kRigid)
    result.stage_residual_mm.emplace_back(
        result.refinement.usable() ? "subdivision, refined" : result.field->method(),
        edge_rms(cad, result.contours, carried));
  for (const ContourResult& contour : result.contours)
    result.density_per_mm2 = std::max(result.density_per_mm2, contour.edge.density_per_mm2);
  result.seen_ratio = seen_ratio(result.contours);
  judge_coverage(cad, options, result);
  if (options.method == RegistrationMethod::kSubdivision) judge_seams(cad, result);
  if (options.method == RegistrationMethod::kProjection) judge_projection(cad, options.projection, result);
  if (options.method != RegistrationMethod::kRigid) judge_residuals(cad, scan, result);
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
