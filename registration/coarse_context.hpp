#pragma once

#include <array>
#include <optional>

#include "registration/coarse_align.hpp"
#include "registration/pose_fitness.hpp"
#include "registration/pose_search.hpp"

namespace arris {

/// What the steps of one coarse alignment share: the question, the search for poses and what counts as a fit.
/// Keeps references to what it was made of.
class CoarseContext {
 public:
  CoarseContext(const CadModel& cad, const ScanModel& scan, const CoarseAlignOptions& options);

  const CadModel& cad;
  const ScanModel& scan;
  const CoarseAlignOptions& options;
  const PoseSearch search;
  const PoseFitness fitness;

  /// The scan, or that with its other side up, made ready when first asked for; not from several threads.
  [[nodiscard]] const LightScan& light(bool flip);
  /// Nothing says which side of the part the scanner saw.
  [[nodiscard]] bool side_open() const { return scan.side == SideKnown::kNo; }

 private:
  std::array<std::optional<LightScan>, 2> light_;
};

}  // namespace arris
