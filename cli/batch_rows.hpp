#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/batch_scans.hpp"
#include "cli/child_process.hpp"
#include "cli/run_result.hpp"

namespace arris {

/// One scan of a batch and what became of it.
struct BatchRow {
  BatchScan scan;
  int exit_code = 0;                ///< of its run; a signal counts as 1
  std::optional<RunResult> result;  ///< of its run folder; none after 1, 3 and 6
  std::string message;            ///< why it is not good, one line: the error, the signal, the first refusal
  bool kept = false;              ///< complete from an earlier batch, not run now
  std::string run_again_because;  ///< an earlier result was there and is of other inputs
  double wall_s = 0.0;            ///< of the process; 0 when kept
};

/// What differs between a stored result and the files as they are now: "the recipe changed"; empty: nothing.
///   inputs   all that a run would take now, the scan among them
[[nodiscard]] std::string difference(const RunResult& result, const std::vector<InputFile>& inputs,
                                     const std::string& version);

/// The row of a scan whose run folder is complete.
[[nodiscard]] BatchRow row_of(const BatchScan& scan, RunResult result);

/// The row of a scan whose process ended without a run folder of its own.
[[nodiscard]] BatchRow row_of_failure(const BatchScan& scan, const ChildEnd& end);

/// The worst of the exit codes, in the order 1, 6, 3, 5, 4, 7, 0.
[[nodiscard]] int worst_exit_code(std::span<const BatchRow> rows);

/// How bad an exit code is: 0 is the worst; as worst_exit_code orders them.
[[nodiscard]] int severity_rank(int exit_code);

/// An exit code in a word: "good", "out of tolerance", "refused", ...
[[nodiscard]] std::string outcome_word(int exit_code);

/// Scans a code; codes that occur, worst first.
[[nodiscard]] std::vector<std::pair<int, std::size_t>> outcome_counts(std::span<const BatchRow> rows);

}  // namespace arris
