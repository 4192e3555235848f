#pragma once

#include "acquisition/contour_extract.hpp"

namespace arris {

/// Measures loops, sorts them longest first, numbers them from 1 and drops those shorter than min_length_mm.
///   bend_chords   half the window of a bend radius, in mean chords: more for the ragged edge of a cloud
[[nodiscard]] ContourSet measured(std::vector<FoundContour> loops, double min_length_mm, double bend_chords);

}  // namespace arris
