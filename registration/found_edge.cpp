#include "registration/found_edge.hpp"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr double kSharpenedSigmaRatio = 0.1;  // scatter of the edge by support, in spacings

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

double edge_rms_mm(const CadModel& cad, const std::vector<ContourResult>& contours, const CarryPoint& carry) {
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

double seen_ratio(const std::vector<ContourResult>& contours) {
  double seen = 0.0, length = 0.0;
  for (const ContourResult& contour : contours) {
    seen += contour.edge.seen_ratio() * contour.motion.nominal().length_mm();
    length += contour.motion.nominal().length_mm();
  }
  return length > 0.0 ? seen / length : 0.0;
}

}  // namespace arris
