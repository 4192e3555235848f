#pragma once

#include <string>
#include <vector>

#include "registration/seams.hpp"
#include "registration/segment_solver.hpp"
#include "registration/subdivision_icp.hpp"

namespace arris {

/// Options of refine_segments().
struct SegmentRefineOptions {
  int max_rounds = 40;         ///< of matching
  int steps_a_round = 5;       ///< of Levenberg-Marquardt between two matchings
  double bend_per_mm = 3e-4;   ///< expected curvature out of the surface: how far a seam may bend open
  double strain_ratio = 1e-3;  ///< expected stretch in the surface: how far it may slide, and turn in it
};

/// One matching and the steps after it.
struct RefineRound {
  double scale_sigmas = 0.0;  ///< of the loss on edge points
  SolverStatement solver;
  double move_mm = 0.0;  ///< largest move of a segment's middle across the contour
};

/// One segment, before and after.
struct RefinedSegment {
  std::size_t contour = 0, segment = 0;
  int pairs = 0;                                   ///< edge points that it carries; 0: its neighbours decided
  double rms_before_mm = 0.0, rms_after_mm = 0.0;  ///< across and normal to the contour, weighted by the loss
};

/// One seam, before and after.
struct RefinedSeam {
  std::size_t contour = 0;
  Seam before, after;
};

/// What the joint fit did.
struct SegmentRefinement {
  bool asked = false;                  ///< false: no joint fit was made, and the rest is empty
  std::vector<ContourMotion> motions;  ///< one a contour; those given when the fit failed
  std::string stop;                    ///< "converged", "round limit", or the reason of a failure
  std::string reason;                  ///< why the motions given were kept; empty when they were refined
  std::vector<RefineRound> rounds;
  std::vector<RefinedSegment> segments;
  std::vector<RefinedSeam> seams;
  [[nodiscard]] bool usable() const { return asked && reason.empty(); }
  /// One sentence: how it ended, after how many rounds, and the root mean square of the seams' jumps.
  [[nodiscard]] std::string statement() const;
};

/// Joint fit of all segments' motions of all contours, after subdivision ICP. A segment alone knows its own
/// points; here a point is fitted by the blend of the segments that carry it (eq. 7, repaired), and
/// neighbours agree at their common cut as far as a part that bends over a segment's length can. So a stretch
/// without data continues both its sides, and a seam opens only where the data say so.
///   data     scan edge points: residuals across and normal to the contour at their foot
///   scan     its surface points near the contours hold the tilt, point to plane, as in subdivision ICP
///   motions  to start from, one a contour
/// Geman-McClure's loss is annealed from the start's residuals to 3 sigmas while partners are found again
/// each round. Deterministic: the solver runs on one thread. Cost: O(rounds * (edge points + stability
/// points)).
[[nodiscard]] SegmentRefinement refine_segments(const CadModel& cad, const ScanModel& scan,
                                                const EdgeData& data,
                                                const std::vector<ContourMotion>& motions,
                                                const SubdivisionIcpOptions& matching,
                                                const SegmentRefineOptions& options);

}  // namespace arris
