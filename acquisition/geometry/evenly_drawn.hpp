#pragma once

#include <cstddef>
#include <vector>

namespace arris {

/// `count` numbers below `size` (all when there are fewer), ascending: one of each of `count` equal
/// stretches, in places that no row of points repeats. The same numbers everywhere.
[[nodiscard]] std::vector<std::size_t> evenly_drawn(std::size_t size, std::size_t count);

}  // namespace arris
