#pragma once

#include <string>
#include <vector>

#include "registration/segment_costs.hpp"

namespace arris {

/// One round of the joint fit: partners are fixed, all segments move.
struct SegmentProblem {
  std::size_t segments = 0;
  std::vector<CarriedCost> edges, surface;
  std::vector<SeamCost> seams;
  std::vector<AnchorCost> anchors;
  double edge_scale_sigmas = 3.0, surface_scale_sigmas = 3.0;  ///< of Geman-McClure's loss
};

/// What the solver says of its run.
struct SolverStatement {
  bool solved = false;      ///< false: the steps are zero
  std::string termination;  ///< "converged", "iteration limit", or the solver's own words when it failed
  int iterations = 0;
  double cost_before = 0.0, cost_after = 0.0;  ///< half the sum of losses
};

struct SegmentSolution {
  SolverStatement statement;
  std::vector<SegmentStep> steps;  ///< one a segment
};

/// Levenberg-Marquardt (Ceres) over the steps of all segments, from zero, at most max_iterations of them.
/// Each segment needs an anchor or a seam, or the answer says that it failed. One thread, so that the bytes
/// are always the same. Cost: sparse, O(segments + points) an iteration.
[[nodiscard]] SegmentSolution solve_segments(const SegmentProblem& problem, int max_iterations);

}  // namespace arris
