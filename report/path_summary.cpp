#include "report/path_summary.hpp"

#include <algorithm>

namespace arris::report {

PathSummary path_summary(const RunRecord& record) {
  PathSummary result;
  const auto& points = record.correction.points;
  result.points = points.empty() ? record.nominal_path.points.size() : points.size();
  result.polylines = polylines(record.nominal_path).size();
  double sum_mm = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CorrectedPoint& p = points[i];
    if (p.air_move) {
      ++result.air_moves;
      continue;
    }
    ++(p.from_data ? result.from_data : result.from_prior);
    sum_mm += p.shift_mm;
    if (p.shift_mm > result.max_shift_mm) {
      result.max_shift_mm = p.shift_mm;
      result.max_shift_row = i + 1;
    }
    result.max_tilt_rad = std::max(result.max_tilt_rad, p.tilt_rad);
    result.max_sd_normal_mm = std::max(result.max_sd_normal_mm, p.sd_normal_mm);
    result.max_sd_across_mm = std::max(result.max_sd_across_mm, p.sd_across_mm);
  }
  const std::size_t counted = result.from_data + result.from_prior;
  if (counted > 0) result.mean_shift_mm = sum_mm / static_cast<double>(counted);
  return result;
}

std::vector<double> path_arc_mm(const ToolPath& path) {
  std::vector<double> arc(path.points.size(), 0.0);
  for (std::size_t i = 1; i < arc.size(); ++i) {
    const PathPoint &before = path.points[i - 1], &here = path.points[i];
    arc[i] = arc[i - 1] + (before.path == here.path ? (here.tip_mm - before.tip_mm).norm() : 0.0);
  }
  return arc;
}

}  // namespace arris::report
