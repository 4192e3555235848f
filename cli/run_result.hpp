#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris {

/// What a table of many runs shows of one, read back from its result.json. Lengths are mm; NaN: not known.
struct RunResult {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::string version, result_hash;
  std::vector<InputFile> inputs;
  int exit_code = 0;                                    ///< 0, 4, 5 or 7
  std::string correction, inspection, inspection_text;  ///< words, and what the inspection's rests on
  std::vector<std::string> refusals;
  double before_mean_mm = kUnknown, before_max_mm = kUnknown;  ///< found edge from the nominal placed rigidly
  double after_mean_mm = kUnknown, after_max_mm = kUnknown;    ///< what the chosen method leaves
  double max_correction_mm = kUnknown, max_tilt_deg = kUnknown;
  double seen_ratio = kUnknown;                                         ///< of the contours' length
  double surface_profile_mm = kUnknown, contour_profile_mm = kUnknown;  ///< 2 max|d| as it was judged
  double total_s = kUnknown;                                            ///< from run.json
};

/// Reads a run folder back. Nothing when it is no complete run folder: absent, cut short, a file missing.
[[nodiscard]] std::optional<RunResult> read_run_result(const std::filesystem::path& folder);

}  // namespace arris
