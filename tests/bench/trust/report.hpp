#pragma once

#include <string>
#include <vector>

#include "tests/bench/trust/study.hpp"

namespace arris::bench {

/// All seeds of one case.
struct StudyResult {
  StudyCase study_case = StudyCase::kComplete;
  std::vector<StudyOutcome> seeds;
};

/// Each stated figure, what was reached (a refused scan is a miss), over how many seeds.
[[nodiscard]] std::string figure_table(const std::vector<StudyResult>& results);
/// Quantiles of the errors over the seeds, one line a case.
[[nodiscard]] std::string distribution_table(const std::vector<StudyResult>& results);
/// Coverage of the 95 % bound by direction, in and out of gaps, one line a case; and by kind of part.
[[nodiscard]] std::string study_coverage_table(const std::vector<StudyResult>& results);
/// The refused scans with their reason.
[[nodiscard]] std::string refusal_list(const std::vector<StudyResult>& results);

}  // namespace arris::bench
