#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/types/point_cloud.hpp"

namespace arris {

/// What is left of a scan, and which of its points that are.
struct ThinnedScan {
  Scan scan;
  std::vector<std::int32_t> kept;  ///< index in the scan before, one a point, ascending
};

/// A scan without some of its points; a triangle goes with any of its corners. Format and notes stay.
///   dropped   indices, ascending, each once; out of range is Error(kBug)
[[nodiscard]] ThinnedScan drop_points(const Scan& scan, std::span<const std::int32_t> dropped);

}  // namespace arris
