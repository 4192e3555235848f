#pragma once

#include <string>
#include <vector>

#include "tests/bench/accuracy/case.hpp"

namespace arris::bench {

/// All seeds of one part scanned in one way.
struct CaseResult {
  std::string part, scan;
  Goal goal = Goal::kNothing;
  bool every_method = false;
  bool along_free = false;  ///< a circle: sliding along the edge is unobservable and harmless
  std::vector<Outcome> seeds;
};

/// One method over the seeds; a seed counts where the method has a result.
struct Summary {
  std::size_t count = 0;
  double mean_mm = 0.0, worst_mean_mm = 0.0;  ///< of the seeds' mean errors
  double max_mm = 0.0, worst_max_mm = 0.0;    ///< of the seeds' peak errors
  double normal_mm = 0.0, across_mm = 0.0, along_mm = 0.0;
};
[[nodiscard]] Summary summary(const CaseResult& result, Method method);

/// Change of the mean (or the peak) error of `method` against `base`, over the seeds where both have a
/// result; -0.75 is three quarters less. NaN when there is none.
[[nodiscard]] double change(const CaseResult& result, Method method, Method base, bool peak);

/// The whole method, one line a case, with yardsticks and refusals.
[[nodiscard]] std::string overview_table(const std::vector<CaseResult>& results);
/// Every method of one case.
[[nodiscard]] std::string case_table(const CaseResult& result);
/// The four rigid ICPs apart, one line a case.
[[nodiscard]] std::string rigid_table(const std::vector<CaseResult>& results);
/// What is asked beside the paper's figures, and what the usual scans reached.
[[nodiscard]] std::string target_table(const std::vector<CaseResult>& results);
/// The refused scans, each with its first reason and what its path would have been off by.
[[nodiscard]] std::string refusal_list(const std::vector<CaseResult>& results);

}  // namespace arris::bench
