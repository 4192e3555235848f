#include "registration/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/rigid_fit.hpp"
#include "registration/seams.hpp"

namespace arris {
namespace {

constexpr double kSeamMm = 2.5,
                 kSeamEdgeLimits = 3.0;    // how far segments may disagree: bending, and the edge limit
constexpr double kAcrossEdgeLimits = 2.0;  // an edge that seems to lie this far off may be the scan's grain
constexpr double kImpossibleStrainRatio = 0.05;
// Rows along the edge of the nose cone: 7 stretches of 210 to 272 mm among 150 scans, each within its bound.
constexpr double kBesideUnseenRatio = 1.5;  // of max_unseen_mm, where the surface beside was scanned
constexpr double kMovedStepMm = 5.0;
constexpr double kResidualMm = 0.15, kResidualSigmas = 5.0;  // of the height beside the edge

/// What two segments may disagree by at their cut, and an edge may lie off the middle between two rows along
/// it.
double seam_limit_mm(const EdgeFit& edge) {
  return kSeamMm + kSeamEdgeLimits * edge.edge_limit_mm();
}

/// A run of bins in which nothing was shown, as arc lengths.
struct Unseen {
  double from_mm = 0.0, length_mm = 0.0, row_gap_mm = 0.0;
};

/// The longest one; wraps on a closed contour.
Unseen longest_unseen(const EdgeFit& edge, const std::vector<char>& shown, bool closed) {
  Unseen longest;
  const std::size_t n = shown.size();
  for (std::size_t start = 0; start < n; ++start) {
    if (shown[start] || (start > 0 && !shown[start - 1])) continue;
    std::size_t run = 0;
    double row_gap_mm = 0.0;
    while (run < n && (closed || start + run < n) && !shown[(start + run) % n])
      row_gap_mm = std::max(row_gap_mm, edge.row_gap_mm[(start + run++) % n]);
    if (static_cast<double>(run) * edge.bin_mm > longest.length_mm)
      longest = {static_cast<double>(start) * edge.bin_mm, static_cast<double>(run) * edge.bin_mm,
                 row_gap_mm};
  }
  return longest;
}

std::string rows_along_edge(double row_gap_mm) {
  return fmt::format(
      ": rows of points {:.1f} mm apart run along it, and it lies anywhere between two; scan it with rows "
      "across the edge",
      row_gap_mm);
}

std::string not_seen(const Curve& curve, const Unseen& gap, double most_mm) {
  return fmt::format("contour {} not seen from s = {:.0f} to {:.0f} mm ({:.0f} mm, at most {:.0f})",
                     curve.contour().id, gap.from_mm, gap.from_mm + gap.length_mm, gap.length_mm, most_mm);
}

/// Stretches that show no edge, or one that may lie anywhere between two rows of points.
void judge_gaps(const Curve& curve, const EdgeFit& edge, const RegistrationOptions& options,
                Registration& result) {
  const double rows_limit_mm = 2.0 * seam_limit_mm(edge);
  std::vector<char> shown = edge.seen;
  for (std::size_t bin = 0; bin < shown.size(); ++bin)
    if (edge.row_gap_mm[bin] >= rows_limit_mm) shown[bin] = 0;
  const Unseen gap = longest_unseen(edge, shown, curve.closed());
  if (gap.length_mm <= options.max_unseen_mm) return;
  result.refusals.push_back(not_seen(curve, gap, options.max_unseen_mm) +
                            (gap.row_gap_mm < rows_limit_mm ? "" : rows_along_edge(gap.row_gap_mm)));
}

/// The surface field ties a stretch without an edge to the rest of the contour and to the surface beside it,
/// where that was scanned (rows of points run along the edge), and knows how well.
void judge_gaps_of_field(const Curve& curve, const EdgeFit& edge, const RegistrationOptions& options,
                         Registration& result) {
  std::vector<char> shown = edge.seen;
  const Unseen no_edge = longest_unseen(edge, shown, curve.closed());
  for (std::size_t bin = 0; bin < edge.beside.size(); ++bin)
    if (edge.beside[bin]) shown[bin] = 1;
  const Unseen nothing = longest_unseen(edge, shown, curve.closed());
  const double most_beside_mm = kBesideUnseenRatio * options.max_unseen_mm;
  if (nothing.length_mm > options.max_unseen_mm)
    result.refusals.push_back(not_seen(curve, nothing, options.max_unseen_mm));
  else if (no_edge.length_mm > most_beside_mm)
    result.refusals.push_back(not_seen(curve, no_edge, most_beside_mm) +
                              ": only the surface beside it was scanned; scan the edge");
}

}  // namespace

void judge_coverage(const CadModel& cad, const RegistrationOptions& options, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const EdgeFit& edge = result.contours[c].edge;
    const int id = cad.contours[c].contour().id;
    if (edge.seen_ratio() < options.min_seen_ratio) {
      result.refusals.push_back(fmt::format(
          "contour {}: the scan shows {:.0f} % of the {}, {:.0f} % needed", id, 100.0 * edge.seen_ratio(),
          options.role == ContourRole::kEdge ? "edge" : "surface along it", 100.0 * options.min_seen_ratio));
    }
    if (options.method == RegistrationMethod::kSurface)
      judge_gaps_of_field(cad.contours[c], edge, options, result);
    else
      judge_gaps(cad.contours[c], edge, options, result);
  }
}

void judge_seams(const CadModel& cad, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const ContourMotion& motion = result.contours[c].motion;
    const double limit_mm = seam_limit_mm(result.contours[c].edge);
    for (const Seam& seam : seams_of(motion)) {
      if (seam.jump_mm < limit_mm) continue;
      result.refusals.push_back(fmt::format(
          "contour {}: the segments on both sides of s = {:.0f} mm disagree by {:.1f} mm (at most {:.1f})",
          cad.contours[c].contour().id, seam.arc_mm, seam.jump_mm, limit_mm));
    }
  }
}

double explained_residual_mm(const ScanModel& scan) {
  return kResidualMm + kResidualSigmas * scan.noise_sigma_mm;
}

void judge_residuals(const CadModel& cad, const ScanModel& scan, Registration& result) {
  for (std::size_t c = 0; c < result.contours.size(); ++c) {
    const double limit_mm = explained_residual_mm(scan);
    if (result.contours[c].edge.residual_sigma_mm < limit_mm) continue;
    result.refusals.push_back(fmt::format(
        "contour {}: the surface beside the edge is not explained: residual {:.2f} mm, scanner noise "
        "{:.2f} mm",
        cad.contours[c].contour().id, result.contours[c].edge.residual_sigma_mm, scan.noise_sigma_mm));
  }
}

void judge_strain(Registration& result) {
  if (std::abs(result.face_strain_ratio) < kImpossibleStrainRatio) return;
  result.refusals.push_back(fmt::format(
      "the contours come out {:.0f} % {} than drawn, which no part on a fixture is: look for folded "
      "triangles in the drawing, and whether it is this part",
      100.0 * std::abs(result.face_strain_ratio), result.face_strain_ratio > 0.0 ? "longer" : "shorter"));
}

void judge_moved(const CadModel& cad, const PoseWatch& watch, Registration& result) {
  std::vector<Eigen::Vector3d> drawn_mm, carried_mm;
  for (std::size_t c = 0; c < result.contours.size(); ++c)
    for (double s_mm = 0.0; s_mm < cad.contours[c].length_mm(); s_mm += kMovedStepMm) {
      drawn_mm.push_back(cad.contours[c].point_mm(s_mm));
      carried_mm.push_back(result.contours[c].motion.at(s_mm) * drawn_mm.back());
    }
  const RigidFit nearest = fit_rigid(drawn_mm, carried_mm);
  if (!nearest.usable()) return;
  const double worse = watch.times_worse(nearest.to_from);
  if (worse <= kAstrayRatio) return;
  result.refusals.push_back(fmt::format(
      "the contours were moved along the part to where the whole scan fits {:.1f} times worse than "
      "where it was found (at most {:.2f}): stray points or gaps led the fit astray; scan the rims again",
      worse, kAstrayRatio));
}

void judge_projection(const CadModel& cad, const ProjectionOptions& options, Registration& result) {
  for (std::size_t c = 0; c < result.projection.size(); ++c) {
    const ContourProjection& found = result.projection[c];
    const std::string contour = "contour " + std::to_string(cad.contours[c].contour().id) + ": ";
    const std::string model = word_of(options.kind);
    if (!found.fit.usable()) {
      result.refusals.push_back(contour + "no " + model + " can be fitted: " + found.fit.reason);
      continue;
    }
    if (found.residual.height_rms_mm > options.max_residual_mm) {
      result.refusals.push_back(
          contour +
          fmt::format("the surface beside it is not bent as a {}: {:.2f} mm rms left (at most {:.2f}); "
                      "registration.projection.model = \"spline\" or method = \"subdivision\" can follow it",
                      model, found.residual.height_rms_mm, options.max_residual_mm));
    }
    const double limit_mm = options.max_residual_mm + kAcrossEdgeLimits * found.edge.edge_limit_mm();
    if (found.residual.across_rms_mm > limit_mm) {
      result.refusals.push_back(
          contour +
          fmt::format(
              "the edge has moved in the surface, which no projection follows: {:.2f} mm rms (at most "
              "{:.2f}); method = \"subdivision\" does",
              found.residual.across_rms_mm, limit_mm));
    }
  }
}

}  // namespace arris
