#include "report/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace arris::report {
namespace {

template <class Number>
std::vector<double> sorted_finite(std::span<const Number> values) {
  std::vector<double> sorted;
  sorted.reserve(values.size());
  for (const Number value : values)
    if (std::isfinite(value)) sorted.push_back(static_cast<double>(value));
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double percentile(const std::vector<double>& sorted, double ratio) {
  const double at = ratio * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

double ratio_of(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

DeviationStatistics from_sorted(const std::vector<double>& sorted, double tolerance_mm) {
  DeviationStatistics result;
  result.count = sorted.size();
  if (sorted.empty()) return result;
  const auto count = static_cast<double>(sorted.size());
  result.min_mm = sorted.front();
  result.max_mm = sorted.back();
  result.mean_mm = std::accumulate(sorted.begin(), sorted.end(), 0.0) / count;
  double spread2 = 0.0;
  for (const double d : sorted) spread2 += (d - result.mean_mm) * (d - result.mean_mm);
  result.sigma_mm = std::sqrt(spread2 / count);
  result.rms_mm = std::hypot(result.mean_mm, result.sigma_mm);
  result.median_mm = percentile(sorted, 0.5);
  result.p05_mm = percentile(sorted, 0.05);
  result.p95_mm = percentile(sorted, 0.95);
  if (!(tolerance_mm > 0.0)) return result;
  const double half = 0.5 * tolerance_mm;
  const auto under = std::lower_bound(sorted.begin(), sorted.end(), -half) - sorted.begin();
  const auto over = sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), half);
  result.under_ratio = ratio_of(static_cast<std::size_t>(under), result.count);
  result.over_ratio = ratio_of(static_cast<std::size_t>(over), result.count);
  result.in_tolerance_ratio = ratio_of(result.count - static_cast<std::size_t>(under + over), result.count);
  return result;
}

// Positive edges: the half zone is cut into equal bins, and the same width goes on beyond it.
std::vector<double> positive_edges(double tolerance_mm, double limit_mm) {
  const double half = tolerance_mm > 0.0 ? 0.5 * tolerance_mm : limit_mm / 20.0;
  const double bins_wanted = 24.0;  // on each side: about what a chart 700 px wide shows well
  const double per_half = std::clamp(std::round(bins_wanted * half / std::max(limit_mm, half)), 1.0, 12.0);
  const double width = half / per_half;
  const auto bins =
      static_cast<std::size_t>(std::clamp(std::ceil(std::max(limit_mm, half) / width - 1e-9), 1.0, 200.0));
  std::vector<double> edges(bins + 1);
  for (std::size_t i = 0; i <= bins; ++i) edges[i] = half * (static_cast<double>(i) / per_half);
  return edges;
}

}  // namespace

DeviationStatistics deviation_statistics(std::span<const float> deviation_mm, double tolerance_mm) {
  return from_sorted(sorted_finite(deviation_mm), tolerance_mm);
}

DeviationStatistics deviation_statistics(std::span<const double> deviation_mm, double tolerance_mm) {
  return from_sorted(sorted_finite(deviation_mm), tolerance_mm);
}

double max_abs_mm(const DeviationStatistics& statistics) {
  if (statistics.count == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::max(std::abs(statistics.min_mm), std::abs(statistics.max_mm));
}

ErrorSummary error_summary(std::span<const double> error_mm) {
  std::vector<double> size(error_mm.size());
  std::transform(error_mm.begin(), error_mm.end(), size.begin(), [](double e) { return std::abs(e); });
  const DeviationStatistics statistics = deviation_statistics(std::span<const double>(size), 0.0);
  return {statistics.count, statistics.mean_mm, statistics.rms_mm, statistics.p95_mm, statistics.max_mm};
}

std::vector<double> after_mm(const ContourError& error) {
  const std::size_t count = std::min(error.across_mm.size(), error.normal_mm.size());
  std::vector<double> after(count);
  for (std::size_t i = 0; i < count; ++i) after[i] = std::hypot(error.across_mm[i], error.normal_mm[i]);
  return after;
}

ContourErrorSummary contour_error_summary(std::span<const ContourError> errors) {
  std::vector<double> rigid, after, across, normal;
  ContourErrorSummary result;
  for (const ContourError& error : errors) {
    const std::vector<double> both = after_mm(error);
    rigid.insert(rigid.end(), error.rigid_mm.begin(), error.rigid_mm.end());
    after.insert(after.end(), both.begin(), both.end());
    across.insert(across.end(), error.across_mm.begin(), error.across_mm.end());
    normal.insert(normal.end(), error.normal_mm.begin(), error.normal_mm.end());
    result.points += error.arc_mm.size();
  }
  result.rigid = error_summary(rigid);
  result.after = error_summary(after);
  result.across = error_summary(across);
  result.normal = error_summary(normal);
  return result;
}

std::size_t Histogram::total() const {
  return std::accumulate(counts.begin(), counts.end(), under + over);
}

Histogram histogram(std::span<const float> deviation_mm, double tolerance_mm, double limit_mm) {
  const std::vector<double> positive = positive_edges(tolerance_mm, limit_mm);
  const std::size_t bins = positive.size() - 1;
  Histogram result;
  for (std::size_t i = bins; i > 0; --i) result.edges_mm.push_back(-positive[i]);
  result.edges_mm.insert(result.edges_mm.end(), positive.begin(), positive.end());
  result.counts.assign(2 * bins, 0);
  for (const float value : deviation_mm) {
    if (!std::isfinite(value)) {
      ++result.no_data;
      continue;
    }
    const double d = value;
    const auto edge = std::lower_bound(positive.begin() + 1, positive.end(), std::abs(d));
    const auto bin = static_cast<std::size_t>(edge - positive.begin()) - 1;  // bins: beyond the last edge
    if (bin >= bins)
      ++(d > 0.0 ? result.over : result.under);
    else
      ++result.counts[d < 0.0 ? bins - 1 - bin : bins + bin];
  }
  return result;
}

}  // namespace arris::report
