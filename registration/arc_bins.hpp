#pragma once

#include <algorithm>
#include <cstddef>

namespace arris {

/// Which of `count` equal bins along a contour an arc length lies in; the last one takes what rounding leaves
/// over.
[[nodiscard]] inline std::size_t arc_bin(double arc_mm, double bin_mm, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, arc_mm / bin_mm)));
}

}  // namespace arris
