#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "registration/surface_pairs.hpp"

namespace arris {

/// Height over the field that neighbouring pairs have in common: a shape that the field does not follow, and
/// noise that is alike for neighbours. Taken over patches of cell_mm on the nominal surface: of the patches'
/// means, less what their scatter explains.
class CommonHeight {
 public:
  /// Pairs off by more than gate_mm, or where nodes are more than most_spacing_mm apart, take no part. Cost
  /// O(n log n).
  CommonHeight(const std::vector<SurfacePair>& pairs, double cell_mm, double gate_mm,
               double most_spacing_mm = std::numeric_limits<double>::max());

  /// Mean square over the pairs.
  [[nodiscard]] double mean_mm2() const;
  /// How much more than known_mm2 there is about each of the nodes, as far as chance does not explain it.
  [[nodiscard]] std::vector<double> excess_mm2(std::size_t nodes, double known_mm2) const;

 private:
  struct Patch {
    double count = 0.0, sum_mm = 0.0;
    const BasisRow* row = nullptr;  // of its first pair
  };
  std::vector<Patch> patches_;
  double scatter_mm2_ = 0.0;  // of a pair about its patch's mean
};

/// Height of a shape that the field does not follow, in cells of cell_mm. Noise that is alike for neighbours
/// falls with the area it is averaged over, a shape does not.
[[nodiscard]] double shape_left_mm(const std::vector<SurfacePair>& pairs, double cell_mm, double gate_mm,
                                   double most_spacing_mm);

}  // namespace arris
