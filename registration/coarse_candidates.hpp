#pragma once

#include <string>
#include <vector>

#include "registration/coarse_context.hpp"

namespace arris {

/// The poses that a search from nothing found.
struct CoarseCandidates {
  std::vector<PoseCandidate> poses;       ///< best first; empty: no start was found
  std::vector<RigidMotion> self_motions;  ///< of the drawing, by which the best was turned to find more
  std::string start;                      ///< how the best was found, in words
  bool by_faces = false;                  ///< it was laid on whatever edges a face has: the last resort
  [[nodiscard]] bool any() const { return !poses.empty() && poses.front().usable(); }
};

/// Whole loops first; then pieces of contours, where no loop fits well; then the surface, and all edges of
/// its faces, where nothing fits. With the side open the other side up is tried as well.
[[nodiscard]] CoarseCandidates coarse_candidates(CoarseContext& context);

/// The poses with the best few, of which none fits, put on the edge by support: extracted points, a spacing
/// inside it and some of them strays, may be what is left, and what hides a pose.
[[nodiscard]] std::vector<PoseCandidate> sharpened(CoarseContext& context, std::vector<PoseCandidate> poses);

}  // namespace arris
