#pragma once

#include <span>
#include <vector>

namespace arris {

/// Where along an edge burrs stand, bin by bin.
struct BurrBins {
  double bin_mm = 0.0;
  std::vector<char> burr;  ///< empty: the scan is too coarse to tell
  [[nodiscard]] bool at(double arc_mm) const;
  [[nodiscard]] double length_mm() const;
  /// So much more on either side of each burr.
  void widen(double by_mm);
};

/// Bins in which far more points stand out of the edge (beyond it, or above the surface beside it) than in
/// the others: a burr is short, and what stands out everywhere is scanner noise. The bins beside count with
/// it. No bin is called when burrs of 0.5 mm would leave too few points to tell, and none of a stretch longer
/// than any burr: there the part itself is bent in a way that the field has not followed.
///   standing_out_mm   arc lengths of the points that stand out
[[nodiscard]] BurrBins find_burr_bins(std::span<const double> standing_out_mm, double length_mm,
                                      double density_per_mm2);

}  // namespace arris
