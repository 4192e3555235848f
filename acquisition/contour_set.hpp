#pragma once

#include "acquisition/contour_extract.hpp"

namespace arris {

/// How a smallest bend radius is taken.
struct BendWindow {
  double chords = 3.0;         ///< half the window, in chords: more for the ragged edge of a cloud
  bool exact_corners = false;  ///< points without noise (a drawing): a turn of more than 63 degrees between
                               ///< two chords is a corner of radius 0, and short chords show their bends
};

/// Measures loops, sorts them longest first, numbers them from 1 and drops those shorter than min_length_mm.
[[nodiscard]] ContourSet measured(std::vector<FoundContour> loops, double min_length_mm,
                                  const BendWindow& bend);

}  // namespace arris
