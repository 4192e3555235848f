#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris::report {

/// Statistics of signed deviations. NaN (no data) is skipped and not counted.
///   tolerance_mm  full width of the zone: in tolerance is |d| <= tolerance_mm / 2; 0: not stated, ratios
///   stay 0 rms is about zero, sigma about the mean (population form): rms^2 = mean^2 + sigma^2 percentiles
///   linear between order statistics
/// Sums run over the sorted values, so the order of the points does not matter to the last bit. Cost O(N log
/// N).
[[nodiscard]] DeviationStatistics deviation_statistics(std::span<const float> deviation_mm,
                                                       double tolerance_mm);
[[nodiscard]] DeviationStatistics deviation_statistics(std::span<const double> deviation_mm,
                                                       double tolerance_mm);

/// Largest |d|; NaN of no data at all.
[[nodiscard]] double max_abs_mm(const DeviationStatistics& statistics);

/// Size of an error along a contour: of |e|, NaN (edge not seen) skipped.
struct ErrorSummary {
  std::size_t count = 0;
  double mean_mm = 0.0, rms_mm = 0.0, p95_mm = 0.0, max_mm = 0.0;
};
[[nodiscard]] ErrorSummary error_summary(std::span<const double> error_mm);

/// Length of the error across and along the normal together, point by point; NaN where either was not seen.
[[nodiscard]] std::vector<double> after_mm(const ContourError& error);

/// Errors of all contours of a run in one row: before (rigid) and after (the chosen method).
struct ContourErrorSummary {
  ErrorSummary rigid, after, across, normal;
  std::size_t points = 0;  ///< seen or not
};
[[nodiscard]] ContourErrorSummary contour_error_summary(std::span<const ContourError> errors);

/// Counts between edges that are symmetric about zero; the limits of the zone are edges. A value on an edge
/// belongs to the bin nearer to zero, so that the bins inside the zone hold exactly the points in tolerance.
struct Histogram {
  std::vector<double> edges_mm;  ///< ascending, one more than counts
  std::vector<std::size_t> counts;
  std::size_t under = 0, over = 0;  ///< beyond the first and the last edge
  std::size_t no_data = 0;
  [[nodiscard]] std::size_t total() const;  ///< all but no_data
};
/// limit_mm > 0: the range shown; it is widened to the next edge. tolerance_mm as above.
[[nodiscard]] Histogram histogram(std::span<const float> deviation_mm, double tolerance_mm, double limit_mm);

}  // namespace arris::report
