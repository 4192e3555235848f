#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/bench/paper/methods.hpp"

namespace arris::bench {

/// Errors of one method over the seeds of one scan.
struct Tally {
  std::string method;
  int seeds = 0;
  std::vector<PathError> errors;        ///< one a seed with a path, refused or not
  std::map<std::string, int> refusals;  ///< reason -> seeds that it was the first reason of
  std::map<std::string, int> failures;  ///< the same of seeds without any path
  [[nodiscard]] int refused() const;    ///< failures included
  [[nodiscard]] double mean_mm(double PathError::*member) const;
  [[nodiscard]] double worst_mm(double PathError::*member) const;
};

/// All methods on `seeds` scans of one part, each scan prepared once.
[[nodiscard]] std::vector<Tally> compare(const BenchPart& part, const synthetic::ScanOptions& scan,
                                         const std::vector<Method>& methods, int seeds);

/// One row a method: mean and largest error, its parts, both against the row called `base`; then the
/// refusals.
[[nodiscard]] std::string error_table(const std::vector<Tally>& tallies, const std::string& base);
/// The refusals as lines of a list, counted and named; empty when there were none.
[[nodiscard]] std::string refusal_list(const std::vector<Tally>& tallies);
/// "0.123 / 0.456": mean and largest error, means of the seeds; with the count of refusals, if any.
[[nodiscard]] std::string short_cell(const Tally& tally);

}  // namespace arris::bench
