#pragma once

#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris::report {

/// The correction of a run in a few numbers; over the rows that follow the part (air moves apart).
struct PathSummary {
  std::size_t points = 0, from_data = 0, from_prior = 0, air_moves = 0, polylines = 0;
  double max_shift_mm = 0.0, mean_shift_mm = 0.0;
  std::size_t max_shift_row = 0;  ///< from 1, as in corrected.csv
  double max_tilt_rad = 0.0;
  double max_sd_normal_mm = 0.0,
         max_sd_across_mm = 0.0;  ///< largest standard deviation of a row; 0: not known
};
[[nodiscard]] PathSummary path_summary(const RunRecord& record);

/// Arc length of each row of the nominal path, going on over its polylines (jumps between them do not count);
/// mm.
[[nodiscard]] std::vector<double> path_arc_mm(const ToolPath& path);

}  // namespace arris::report
