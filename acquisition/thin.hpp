#pragma once

#include <cstddef>

#include "acquisition/types/point_cloud.hpp"

namespace arris {

/// At most about `points` measured points of a cloud, evenly over its surface: of some ten times as many
/// drawn evenly from the whole, one a voxel, never a mean. A cloud that is no larger comes back as it is.
/// Cost O(N) for reading, the rest depends on `points` alone.
[[nodiscard]] PointCloud thinned_to(const PointCloud& cloud, std::size_t points);

}  // namespace arris
