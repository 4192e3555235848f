#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace arris {

/// The middle value, of an even number the upper one; 0 when there is none. O(n); takes its own copy.
[[nodiscard]] inline double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace arris
