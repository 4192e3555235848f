#pragma once

#include <string>
#include <vector>

#include "tests/bench/pictures/figure.hpp"
#include "tests/support/bench_part.hpp"

namespace arris::bench {

/// Of one part: how it is really bent, and the error of its corrected path along the contours (usual scan,
/// seed 1) with the stated 95 % bounds. A refused scan gives the first picture alone.
[[nodiscard]] std::vector<Figure> part_pictures(const BenchPart& part);

/// Markdown that shows them; folder as seen from the page.
[[nodiscard]] std::string pictures_text(const std::vector<Figure>& figures, const std::string& folder);

}  // namespace arris::bench
