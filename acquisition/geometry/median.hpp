#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace arris {

/// The value that `share` (below 1) of the others lie below; 0 when there is none. O(n); takes its own copy.
[[nodiscard]] inline double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The middle value, of an even number the upper one.
[[nodiscard]] inline double median_of(std::vector<double> values) {
  return quantile_of(std::move(values), 0.5);
}

}  // namespace arris
