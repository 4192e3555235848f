#pragma once

#include "acquisition/contour_extract.hpp"

namespace arris {

/// Measures loops, sorts them longest first, numbers them from 1 and drops those shorter than min_length_mm.
[[nodiscard]] ContourSet measured(std::vector<FoundContour> loops, double min_length_mm);

}  // namespace arris
