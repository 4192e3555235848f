#pragma once

#include <vector>

#include "acquisition/types/contour.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// A start pose from two loops laid on each other.
struct LoopMatch {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  double rms_mm = 0.0;  ///< of the loops' points, arc length to arc length
  int cad_loop = 0;     ///< index into the CAD loops
  int scan_loop = 0;    ///< index into the scan loops
};

/// Every way to lay a scan loop on a CAD loop: both are cut into the same number of arcs, every start shift
/// is fitted by Horn's closed form, and the shifts that are local minima of the rms are kept, best first. A
/// scan chain that a gap leaves open is laid on the part of the CAD loop that it can cover. Loops are
/// compared in their own direction (material on the left), so both must be oriented; loops whose lengths
/// differ by more than length_ratio are not compared whole. Cost O(loops^2 * n^2), n = 64.
[[nodiscard]] std::vector<LoopMatch> match_loops(const std::vector<Contour>& cad_loops,
                                                 const std::vector<Contour>& scan_loops,
                                                 double length_ratio = 1.6);

/// Pieces of the scan's loops and chains, half a CAD loop and a third of it long, laid on the CAD loops, best
/// first: a gap, a clamp or the border of the scan makes one long loop of the contour and what is beside it.
/// Cost O(length of the scan's loops / length of the CAD's * 16 * n^2), n = 64.
[[nodiscard]] std::vector<LoopMatch> match_pieces(const std::vector<Contour>& cad_loops,
                                                  const std::vector<Contour>& scan_loops);

}  // namespace arris
