#pragma once

#include <vector>

namespace arris {

/// Of the usual number of points: a bin with fewer is empty.
inline constexpr double kEmptyBinRatio = 0.2;

/// A scan point beside an edge, as the edge sees it.
struct BesidePoint {
  double arc_mm = 0.0;
  double across_mm = 0.0;  ///< into the material
  double weight = 1.0;     ///< undoes the fan of a bent contour
};

/// Where along an edge the scan shows material right up to it, in bins of arc length.
struct SeenBins {
  double bin_mm = 0.0;
  std::vector<char> seen;
  double density_per_mm2 = 0.0;  ///< of the strip, median over the bins

  [[nodiscard]] std::size_t bin_of(double arc_mm) const;
  [[nodiscard]] bool seen_at(double arc_mm) const { return seen[bin_of(arc_mm)] != 0; }
};

/// The strip of material beside an edge.
struct StripSize {
  double length_mm = 0.0, width_mm = 0.0;
  double near_mm = 0.0;     ///< the part of the width that must hold points for the edge to count as seen
  double spacing_mm = 0.0;  ///< of the scan
};

/// Bins hold some 8 points each. One is not seen when it, or its part near the edge, has less than a fifth
/// of the usual number; beside such a bin less than three fifths near the edge, for the rim of a gap cuts its
/// neighbours too. Where most of the edge is missing the scan's own spacing says what is usual.
///   points    at most width_mm inside
///   weight    of those that make up the strip's density, for the size of the bins
[[nodiscard]] SeenBins find_seen_bins(const std::vector<BesidePoint>& points, double weight,
                                      const StripSize& strip);

}  // namespace arris
