#pragma once

#include <string>
#include <vector>

namespace arris {

/// The joint fit of all segments, in numbers for the report; empty unless the recipe asks for it.
struct RefinementSummary {
  struct Round {
    double scale_sigmas = 0.0;  ///< of the loss on edge points
    double cost_before = 0.0, cost_after = 0.0;
    int iterations = 0;
    std::string termination;
    double move_mm = 0.0;
  };
  struct SegmentChange {
    int contour = 0;
    double from_mm = 0.0, to_mm = 0.0;
    int pairs = 0;
    double rms_before_mm = 0.0, rms_after_mm = 0.0;
  };
  struct SeamChange {
    int contour = 0;
    double arc_mm = 0.0;
    double jump_before_mm = 0.0, jump_after_mm = 0.0;
    double turn_before_rad = 0.0, turn_after_rad = 0.0;
  };
  bool asked = false;
  bool used = false;      ///< false: the motions of subdivision ICP were kept
  std::string statement;  ///< in plain words, what came of it
  std::vector<Round> rounds;
  std::vector<SegmentChange> segments;
  std::vector<SeamChange> seams;
};

}  // namespace arris
