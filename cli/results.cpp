#include "cli/results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "report/statistics.hpp"
#include "report/verdict.hpp"

namespace arris {
namespace {

constexpr double kSampleMm = 2.0;
constexpr double kSurfaceLimitRadiusMm = 10.0;
constexpr double kExpanded = 2.0;  // k
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

ContourError error_along(const CadModel& cad, std::size_t c, const Registration& found) {
  const Curve& curve = cad.contours[c];
  const EdgeFit& edge = found.contours[c].edge;
  ContourError error;
  error.contour = "contour " + std::to_string(curve.contour().id);
  const int count = std::max(8, static_cast<int>(curve.length_mm() / kSampleMm));
  for (int i = 0; i < count; ++i) {
    const double s_mm = curve.length_mm() * i / count;
    const bool seen = edge.seen_at(s_mm);
    const SplineRow row = edge.spline.at(s_mm);
    error.arc_mm.push_back(s_mm);
    error.rigid_mm.push_back(seen ? rigid_gap_mm(cad, c, found, s_mm) : kMissing);
    error.across_mm.push_back(seen ? -row.dot(edge.across) : kMissing);  // positive towards the void
    error.normal_mm.push_back(seen ? height_gap_mm(c, found, s_mm) : kMissing);
  }
  return error;
}

/// Largest stated standard deviation of the edge across, over the part that was seen. A projection cannot
/// tell an error of the edge from a bending that moved it in the surface, so all that it leaves there is in
/// it.
double worst_edge_sd_mm(const Registration& found) {
  double worst = 0.0;
  for (std::size_t c = 0; c < found.contours.size(); ++c) {
    const ContourResult& contour = found.contours[c];
    const Curve& curve = contour.motion.nominal();
    const double moved_mm = found.projection.empty() ? 0.0 : found.projection[c].residual.across_rms_mm;
    for (double s_mm = 0.0; s_mm < curve.length_mm(); s_mm += kSampleMm)
      if (contour.edge.seen_at(s_mm))
        worst = std::max(worst, std::hypot(contour.edge.sd_across_mm(s_mm, curve.closed()), moved_mm));
  }
  return worst;
}

void judge_shape(RunRecord& record) {
  record.as_scanned = report::deviation_statistics(record.deviation_mm, record.surface_profile_mm);
  const double largest_mm = report::max_abs_mm(record.as_scanned);
  if (record.state == "free") {
    record.judged_as_scanned =
        report::judge_profile(largest_mm, record.surface_profile_mm, 2.0 * kExpanded * record.noise_sigma_mm,
                              "scan against CAD after the rigid alignment");
  } else {
    record.judged_as_scanned =
        report::not_judged(largest_mm, record.surface_profile_mm, "as clamped, not judged");
  }
}

std::string what_is_judged(const std::string& method) {
  if (method == "rigid") return "found edge against the nominal carried rigidly";
  if (method == "surface") return "found edge against the nominal carried by the surface field";
  if (method == "projection")
    return "found edge against the nominal carried by the projection (an error of the edge cannot be told "
           "from "
           "bending that moved it in the surface; the uncertainty holds both)";
  return "found edge against the nominal carried by the segments (an error longer than a segment is "
         "followed, "
         "and not seen here)";
}

void judge_edge(const Registration& found, RunRecord& record) {
  std::vector<double> across_mm;
  for (const ContourError& error : record.contour_errors)
    across_mm.insert(across_mm.end(), error.across_mm.begin(), error.across_mm.end());
  record.pulled_back =
      report::deviation_statistics(std::span<const double>(across_mm), record.contour_profile_mm);
  const double largest_mm = report::max_abs_mm(record.pulled_back);
  if (record.role == "cut") {
    record.judged_pulled_back =
        report::not_judged(0.0, record.contour_profile_mm, "role cut: the tool makes the contour");
    return;
  }
  record.judged_pulled_back =
      record.state == "free"
          ? report::not_judged(largest_mm, record.contour_profile_mm,
                               "the edge's own error, shown; the free shape is judged")
          : report::judge_profile(largest_mm, record.contour_profile_mm,
                                  2.0 * kExpanded * worst_edge_sd_mm(found), what_is_judged(record.method));
}

}  // namespace

void judge_results(const CadModel& cad, const Registration& found, RunRecord& record) {
  if (record.role == "cut") {
    record.edge_limit_mm = kMissing;  // there is no edge to show
  } else {
    for (std::size_t c = 0; c < cad.contours.size(); ++c)
      record.contour_errors.push_back(error_along(cad, c, found));
    for (const ContourResult& contour : found.contours)
      record.edge_limit_mm = std::max(record.edge_limit_mm, contour.edge.edge_limit_mm());
  }
  const double density = std::max(found.density_per_mm2, 1e-12);
  const double near_points =
      std::max(1.0, density * 0.5 * std::numbers::pi * kSurfaceLimitRadiusMm * kSurfaceLimitRadiusMm);
  record.surface_limit_mm = record.noise_sigma_mm / std::sqrt(near_points);
  judge_shape(record);
  judge_edge(found, record);
}

}  // namespace arris
