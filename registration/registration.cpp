#include "registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "registration/edge_pairs.hpp"

namespace arris {
namespace {

constexpr double kSharpenedSigmaRatio = 0.1;  // scatter of the edge by support, in spacings
constexpr int kSharpeningPasses = 2;
constexpr double kRigidStartLooseness = 8.0;
constexpr int kRigidPasses = 1;           // of the rigid ICP on the edge by support
constexpr int kRigidSurfacePoints = 500;  // the surface counts as 100 points, however many there are
constexpr double kSampleMm = 2.0;
constexpr double kSeamMm = 2.5,
                 kSeamEdgeLimits = 3.0;  // how far segments may disagree: bending, and the edge limit
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

std::vector<ContourResult> with_edges(const CadModel& cad, const ScanModel& scan,
                                      std::vector<ContourMotion> motions, const EdgeFitOptions& options) {
  std::vector<ContourResult> results;
  for (std::size_t c = 0; c < motions.size(); ++c) {
    EdgeFit edge = fit_edge(cad, c, scan, motions[c], options);
    results.push_back({std::move(motions[c]), std::move(edge)});
  }
  return results;
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

double stretch(const CadModel& cad, const std::vector<ContourResult>& contours) {
  double carried_mm = 0.0, nominal_mm = 0.0;
  for (std::size_t c = 0; c < contours.size(); ++c) {
    Contour image;
    image.closed = cad.contours[c].closed();
    along(cad.contours[c], [&](double s_mm) {
      image.points_mm.push_back(contours[c].motion.at(s_mm) * cad.contours[c].point_mm(s_mm));
    });
    Contour flat = image;
    flat.points_mm.clear();
    along(cad.contours[c], [&](double s_mm) { flat.points_mm.push_back(cad.contours[c].point_mm(s_mm)); });
    carried_mm += length_mm(image);
    nominal_mm += length_mm(flat);
  }
  return nominal_mm > 0.0 ? carried_mm / nominal_mm - 1.0 : 0.0;
}

/// What two segments may disagree by at their cut, and an edge may lie off the middle between two rows along
/// it.
double seam_limit_mm(const EdgeFit& edge) {
  const double edge_limit_mm = 1.0 / (50.0 * std::max(edge.density_per_mm2, 1e-9));
  return kSeamMm + kSeamEdgeLimits * edge_limit_mm;
}

/// Longest run of bins that show no edge, or one that may lie anywhere between two rows of points; as arc
/// lengths; wraps on a closed contour.
struct Unseen {
  double from_mm = 0.0, length_mm = 0.0, row_gap_mm = 0.0;
};
Unseen longest_unseen(const EdgeFit& edge, bool closed) {
  Unseen longest;
  const std::size_t n = edge.seen.size();
  const double rows_limit_mm = 2.0 * seam_limit_mm(edge);
  const auto shown = [&](std::size_t bin) { return edge.seen[bin] && edge.row_gap_mm[bin] < rows_limit_mm; };
  for (std::size_t start = 0; start < n; ++start) {
    if (shown(start) || (start > 0 && !shown(start - 1))) continue;
    std::size_t run = 0;
    double row_gap_mm = 0.0;
    while (run < n && (closed || start + run < n) && !shown((start + run) % n))
      row_gap_mm = std::max(row_gap_mm, edge.row_gap_mm[(start + run++) % n]);
    if (static_cast<double>(run) * edge.bin_mm > longest.length_mm)
      longest = {static_cast<double>(start) * edge.bin_mm, static_cast<double>(run) * edge.bin_mm,
                 row_gap_mm < rows_limit_mm ? 0.0 : row_gap_mm};
  }
  return longest;
}

/// Where two neighbouring segments disagree about the place of their common cut, one of them is wrong.
void judge_seams(const CadModel& cad, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const ContourMotion& motion = result.contours[c].motion;
    const std::vector<Segment>& segments = motion.subdivision().segments();
    const double limit_mm = seam_limit_mm(result.contours[c].edge);
    for (std::size_t z = 0; z < segments.size(); ++z) {
      const std::size_t next = (z + 1) % segments.size();
      if (next == z || (next == 0 && !cad.contours[c].closed())) continue;
      const double s_mm = cad.contours[c].wrap_mm(segments[z].end_mm);
      const Eigen::Vector3d p = cad.contours[c].point_mm(s_mm);
      // along the contour a segment may slide: that moves no edge
      Eigen::Vector3d apart = motion.fits()[z].scan_from_cad * p - motion.fits()[next].scan_from_cad * p;
      const Eigen::Vector3d tangent = motion.fits()[z].scan_from_cad.linear() * cad.contours[c].tangent(s_mm);
      apart -= apart.dot(tangent) * tangent;
      if (apart.norm() < limit_mm) continue;
      char text[200];
      std::snprintf(
          text, sizeof text,
          "contour %d: the segments on both sides of s = %.0f mm disagree by %.1f mm (at most %.1f)",
          cad.contours[c].contour().id, s_mm, apart.norm(), limit_mm);
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

std::string rows_along_edge(double row_gap_mm) {
  char text[200];
  std::snprintf(
      text, sizeof text,
      ": rows of points %.1f mm apart run along it, and it lies anywhere between two; scan it with rows "
      "across the edge",
      row_gap_mm);
  return text;
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

/// Rigid ICP once more, on the edge by support. Extracted edge points end up to a spacing inside the
/// material, of a scan in rows up to the distance of the rows, and not alike all around: such a pose slides
/// along an oval.
void refine_rigid(const CadModel& cad, ScanModel& scan, const RegistrationOptions& options,
                  Registration& result) {
  std::vector<Eigen::Vector3d> extracted =
      std::exchange(scan.edge_mm, sharpened(cad, scan, result.contours).points_mm);
  RigidIcpOptions icp = options.rigid;
  icp.start_scale_mm = 4.0 * scan.spacing_mm;
  icp.surface_points = std::min(icp.surface_points, kRigidSurfacePoints);
  icp.with_covariance = true;
  RigidIcpResult refined = icp_point_to_plane(cad, scan, result.rigid.scan_from_cad, icp);
  scan.edge_mm = std::move(extracted);
  if (!refined.usable()) return;
  add_edge_covariance(cad, result.contours, refined);
  result.rigid = std::move(refined);
  result.contours = edges_from_rigid(cad, scan, result.rigid.scan_from_cad, options.edge);
}

void deform(const CadModel& cad, ScanModel& scan, const RegistrationOptions& options, Registration& result) {
  result.contours = edges_from_rigid(cad, scan, result.rigid.scan_from_cad, options.edge);
  for (int pass = 0; pass < kRigidPasses; ++pass) refine_rigid(cad, scan, options, result);
  const RigidMotion& rigid = result.rigid.scan_from_cad;
  if (options.method == RegistrationMethod::kRigid) {
    result.field = std::make_shared<RigidField>(rigid);
    return;
  }
  std::vector<ContourMotion> earlier;
  for (int pass = 0; pass < kSharpeningPasses; ++pass) {
    const EdgeData edge = sharpened(cad, scan, result.contours);
    std::vector<ContourMotion> moved = subdivision_icp(cad, scan, edge, rigid, options.subdivision, earlier);
    earlier = moved;
    result.contours = with_edges(cad, scan, std::move(moved), options.edge);
  }
  result.field =
      std::make_shared<SubdivisionField>(cad, result.contours, options.band_mm, options.follow_edge);
}

}  // namespace

Registration register_part(const CadModel& cad, ScanModel& scan, const RegistrationOptions& options) {
  Registration result;
  result.coarse = coarse_align(cad, scan, options.coarse);
  if (!result.coarse.usable()) {
    result.refusals.push_back(result.coarse.reason);
    return result;
  }
  if (result.coarse.flipped_normals) flip(scan);
  scan.side = SideKnown::kYes;
  drop_other_loops(cad, scan, result.coarse.scan_from_cad, options.coarse.band_mm, result.loops);
  RigidIcpOptions rigid = options.rigid;
  rigid.start_scale_mm = std::max(3.0 * result.coarse.score_mm, 4.0 * scan.spacing_mm);
  rigid.surface_points = std::min(rigid.surface_points, kRigidSurfacePoints);
  result.rigid = icp_point_to_plane(cad, scan, result.coarse.scan_from_cad, rigid);
  if (!result.rigid.usable()) {
    result.refusals.push_back(result.rigid.reason);
    return result;
  }
  deform(cad, scan, options, result);
  double size_mm = 1.0;
  for (const Curve& curve : cad.contours) size_mm = std::max(size_mm, curve.length_mm() / 6.28);
  result.free_directions = free_directions(result.rigid.information, result.rigid.pivot_mm, size_mm);
  const RigidMotion& pose = result.rigid.scan_from_cad;
  result.stage_residual_mm.emplace_back(
      "rigid", edge_rms(cad, result.contours,
                        [&](std::size_t, double, const Eigen::Vector3d& p) { return pose * p; }));
  if (options.method == RegistrationMethod::kSubdivision)
    result.stage_residual_mm.emplace_back(
        "subdivision",
        edge_rms(cad, result.contours, [&](std::size_t c, double s_mm, const Eigen::Vector3d& p) {
          return result.contours[c].motion.at(s_mm) * p;
        }));
  result.mean_strain_ratio = stretch(cad, result.contours);
  for (const ContourResult& contour : result.contours)
    result.density_per_mm2 = std::max(result.density_per_mm2, contour.edge.density_per_mm2);
  judge_coverage(cad, options, result);
  if (options.method == RegistrationMethod::kSubdivision) {
    judge_seams(cad, result);
    judge_residuals(cad, scan, result);
  }
  return result;
}

double rigid_gap_mm(const CadModel& cad, std::size_t contour, const Registration& registration,
                    double arc_mm) {
  const ContourResult& found = registration.contours[contour];
  const Eigen::Vector3d edge_mm = edge_point_mm(cad, contour, found.motion, found.edge, arc_mm);
  return cad.contours[contour].nearest(registration.rigid.scan_from_cad.inverse() * edge_mm).distance_mm;
}

}  // namespace arris
