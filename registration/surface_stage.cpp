#include "registration/surface_stage.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "registration/found_edge.hpp"
#include "registration/judge.hpp"
#include "registration/surface_field.hpp"

namespace arris {
namespace {

constexpr double kMotionStepMm = 10.0;  // the field along a contour is sampled this finely
constexpr double kJudgeStepMm = 5.0;    // and its uncertainty
constexpr double kUnfollowedEdgeMm = 0.3,
                 kUnfollowedEdgeLimits = 2.0;  // rms; right fits leave half an edge limit
constexpr double kMostOffsetSds = 2.0;
constexpr double kSlideShare = 0.5;  // of the worst variance: then the whole contour slides
constexpr double kLeastSlideMm = 4.0, kLeastSlideSpacings = 1.5;  // a slide that is refused
constexpr double kNearSpacings = 3.0, kNearMm = 3.0;  // a scan point this near makes a place "data"

/// Edge of a contour that is not there yet: none.
EdgeFit no_edge(const Curve& curve, const EdgeFitOptions& options) {
  EdgeFit none(ArcSpline(curve.length_mm(), curve.closed(), options.knot_mm));
  none.bin_mm = SeenAlong::kBinMm;
  return none;
}

std::string text_of(const Eigen::Vector3d& direction) {
  return fmt::format("({:.2f} {:.2f} {:.2f})", direction.x(), direction.y(), direction.z());
}

/// Worst standard deviation across a contour or normal to it, and where.
struct Worst {
  double sd_mm = 0.0, arc_mm = 0.0;
};
Worst worst_place(const SurfaceField& field, const Curve& curve) {
  Worst worst;
  for (double s_mm = 0.0; s_mm < curve.length_mm(); s_mm += kJudgeStepMm) {
    const double sd_mm = field.map(curve.point_mm(s_mm)).sd_mm.head<2>().maxCoeff();
    if (sd_mm > worst.sd_mm) worst = {sd_mm, s_mm};
  }
  return worst;
}

void judge_place(const CadModel& cad, const SurfaceField& field, const RegistrationOptions& options,
                 Registration& result) {
  for (std::size_t c = 0; c < cad.contours.size(); ++c) {
    const Worst worst = worst_place(field, cad.contours[c]);
    if (worst.sd_mm <= options.max_sd_mm) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> slide(field.slide_covariance_mm2(c));
    const bool slides = slide.eigenvalues()[2] > kSlideShare * worst.sd_mm * worst.sd_mm;
    const int id = cad.contours[c].contour().id;
    if (slides) {
      const std::string motion = "slide along " + text_of(slide.eigenvectors().col(2)) + " of the scan";
      result.refusals.push_back(
          fmt::format("contour {}: nothing in the scan holds its {}: standard deviation {:.1f} mm, at most "
                      "{:.1f}; scan an outline or datum holes of the drawing as well",
                      id, motion, worst.sd_mm, options.max_sd_mm));
      result.free_directions.push_back(motion);
    } else {
      result.refusals.push_back(fmt::format(
          "contour {}: its place is not known well enough at s = {:.0f} mm: standard deviation {:.1f} mm, at "
          "most {:.1f}",
          id, worst.arc_mm, worst.sd_mm, options.max_sd_mm));
    }
  }
}

/// Where the edge was seen, bin by bin; of a contour that is not there yet, where scan points are near.
SeenAlong seen_along(const ScanModel& scan, const Curve& curve, const ContourResult& contour,
                     ContourRole role) {
  SeenAlong along;
  const double near_mm = kNearSpacings * scan.spacing_mm + kNearMm;
  for (double s_mm = 0.5 * SeenAlong::kBinMm; s_mm < curve.length_mm(); s_mm += SeenAlong::kBinMm) {
    if (role == ContourRole::kEdge) {
      along.bins.push_back(contour.edge.seen_at(s_mm) ? 1 : 0);
      continue;
    }
    const Neighbour nearest = scan.tree.nearest(contour.motion.at(s_mm) * curve.point_mm(s_mm));
    along.bins.push_back(nearest.index >= 0 && nearest.distance2_mm2 < near_mm * near_mm ? 1 : 0);
  }
  return along;
}

double seen_ratio(const std::vector<SeenAlong>& contours) {
  double seen = 0.0, count = 1e-9;
  for (const SeenAlong& along : contours) {
    seen += static_cast<double>(std::count(along.bins.begin(), along.bins.end(), 1));
    count += static_cast<double>(along.bins.size());
  }
  return seen / count;
}

/// Role cut: of the contour nothing can be seen, but the surface that it will be cut into must be.
void judge_cut(const CadModel& cad, const ScanModel& scan, const std::vector<SeenAlong>& seen,
               double sigma_mm, const RegistrationOptions& options, Registration& result) {
  result.seen_ratio = seen_ratio(seen);
  for (std::size_t c = 0; c < seen.size(); ++c) {
    EdgeFit& none = result.contours[c].edge;
    none.seen = seen[c].bins;
    none.row_gap_mm.assign(none.seen.size(), 0.0);
  }
  judge_coverage(cad, options, result);
  result.stage_residual_mm = {{"rigid", result.rigid.surface_rms_mm}, {"surface", sigma_mm}};
  if (sigma_mm < explained_residual_mm(scan)) return;
  result.refusals.push_back(
      fmt::format("the surface is not explained: residual {:.2f} mm, scanner noise {:.2f} mm", sigma_mm,
                  scan.noise_sigma_mm));
}

/// Role edge: an edge that lies elsewhere than where the field carries it, its own offset aside, was not
/// followed: the rigid start was wrong, or something else than this contour was seen.
void judge_edges(const CadModel& cad, const SurfaceField& field, const RegistrationOptions& options,
                 Registration& result) {
  for (std::size_t c = 0; c < cad.contours.size(); ++c) {
    const EdgeFit& edge = result.contours[c].edge;
    const Curve& curve = cad.contours[c];
    double sum2 = 0.0, count = 1e-9;
    along(curve, [&](double s_mm) {
      if (!edge.seen_at(s_mm)) return;
      const double off_mm = edge.spline.at(s_mm).dot(edge.across) - field.fit().offset_mm[c];
      sum2 += off_mm * off_mm;
      count += 1.0;
    });
    const double rms_mm = std::sqrt(sum2 / count), offset_mm = field.fit().offset_mm[c];
    const double most_offset_mm = kMostOffsetSds * options.surface.offset_sd_mm + edge.edge_limit_mm();
    if (std::abs(offset_mm) > most_offset_mm) {
      result.refusals.push_back(fmt::format(
          "contour {}: its edge lies {:.2f} mm {} the drawn one all round, at most {:.2f}: the part is "
          "of another size, was placed wrongly, or registration.surface.offset_sd_mm must be larger",
          curve.contour().id, std::abs(offset_mm), offset_mm > 0.0 ? "inside" : "outside", most_offset_mm));
      continue;
    }
    const double limit_mm = kUnfollowedEdgeMm + kUnfollowedEdgeLimits * edge.edge_limit_mm();
    if (rms_mm <= limit_mm) continue;
    result.refusals.push_back(fmt::format(
        "contour {}: the edge in the scan is not explained: {:.2f} mm rms beside where the field carries "
        "it, at most {:.2f}; scan.initial in the recipe helps when the part was placed wrongly",
        curve.contour().id, rms_mm, limit_mm));
  }
}

/// A fit that slid along the part and took the edges it left behind for gaps.
void judge_slide(const SurfaceField& field, double spacing_mm, Registration& result) {
  if (!is_slide(field.fit().elsewhere.by_mm.norm(), spacing_mm)) return;
  result.refusals.push_back(fmt::format(
      "the edges would be seen much better with the part moved by {:.0f} mm: it was placed wrongly; "
      "scan.initial in the recipe helps, or a scan of what is missing",
      field.fit().elsewhere.by_mm.norm()));
}

}  // namespace

bool is_slide(double moved_mm, double spacing_mm) {
  return moved_mm >= std::max(kLeastSlideMm, kLeastSlideSpacings * spacing_mm);
}

void deform_by_surface(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
                       Registration& result) {
  SurfaceOptions surface = options.surface;
  surface.prior.thickness_mm = 2.0 * options.mid_depth_mm;
  SurfaceFit fit = refine_surface(cad, scan, result.rigid.scan_from_cad, surface);
  if (!fit.usable()) {
    result.refusals.push_back(fit.reason);
    return;
  }
  auto field = std::make_shared<SurfaceField>(cad, std::move(fit), options.band_mm, options.role);
  std::vector<ContourMotion> motions;
  for (std::size_t c = 0; c < cad.contours.size(); ++c)
    motions.push_back(sampled_motion(cad.contours[c], kMotionStepMm,
                                     [&](double s_mm) { return field->material_motion(c, s_mm); }));
  EdgeFitOptions edge = options.edge;
  edge.start_sigma_mm = field->fit().sigma_mm;
  if (options.role == ContourRole::kEdge)
    result.contours = with_edges(cad, scan, std::move(motions), edge);
  else
    for (std::size_t c = 0; c < motions.size(); ++c)
      result.contours.push_back({std::move(motions[c]), no_edge(cad.contours[c], options.edge)});
  std::vector<SeenAlong> seen;
  for (std::size_t c = 0; c < cad.contours.size(); ++c)
    seen.push_back(seen_along(scan, cad.contours[c], result.contours[c], options.role));
  if (options.role == ContourRole::kCut) judge_cut(cad, scan, seen, field->fit().sigma_mm, options, result);
  field->set_seen(std::move(seen));
  judge_slide(*field, scan.spacing_mm, result);
  if (options.role == ContourRole::kEdge) judge_edges(cad, *field, options, result);
  judge_place(cad, *field, options, result);
  result.field = std::move(field);
}

}  // namespace arris
