#pragma once

#include <string>
#include <vector>

#include "tests/bench/accuracy/goal_row.hpp"
#include "tests/bench/accuracy/table.hpp"

namespace arris::bench {

/// What is asked of the finite element parts, case by case: errors against the edge limit E or in mm, against
/// the best rigid motion, the bracket's medians, tool axes.
[[nodiscard]] std::vector<GoalRow> part_goals(const std::vector<CaseResult>& results);

/// Quantiles of mean and peak error over the accepted seeds, one line a case.
[[nodiscard]] std::string distribution_table(const std::vector<CaseResult>& results);

/// Of each part, over all its scans: share of the true errors inside the stated 95 % bound and the bound over
/// the error, by direction, outside gaps and in them.
[[nodiscard]] std::string part_coverage_table(const std::vector<CaseResult>& results);

}  // namespace arris::bench
