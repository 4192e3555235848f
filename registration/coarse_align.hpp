#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/free_directions.hpp"
#include "registration/scene.hpp"

namespace arris {

/// Options of coarse_align().
struct CoarseAlignOptions {
  std::optional<RigidMotion> initial_scan_from_cad;  ///< given by the recipe: no search, only checked
  double within_rad = 0.52;  ///< an initial pose that the data turn by more is refused
  double band_mm = 60.0;     ///< surface that takes part, around the contours
  bool edges_needed =
      true;  ///< false: an initial pose is taken though the scan shows no contour of the drawing
  std::vector<Contour> path = {};  ///< the tool path, normals its axes; empty: it runs round each contour
  double ambiguity_ratio = 1.10;   ///< runner-up's score over the best's below this: refused
  int threads = 0;
};

/// A start pose, or why there is none; read the pose only if usable().
struct CoarseAlignment {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  double score_mm = 0.0;         ///< capped rms of contour to scan edge and of scan to surface
  double runner_up_ratio = 0.0;  ///< score of the best other pose over score_mm; 0: there was no other
  int equal_poses = 1;           ///< that fit alike and differ by motions that map the whole path onto itself
  bool flipped_normals = false;  ///< the side was unknown and the shape decided for the other sign
  std::string start;  ///< "matching loops", "matching pieces of contours", "matching surfaces", "matching the
                      ///< edges of faces", "initial pose"
  std::string reason;         ///< refusal in plain words; empty when usable
  double mirror_ratio = 0.0;  ///< score of the scan's mirror image over score_mm; near 1: a mirrored export
                              ///< would not be noticed. 0: not tried
  bool inverted =
      false;  ///< it fits with its normals turned round: the drawing's or the scan's point the wrong way
  bool mirrored = false;  ///< the scan's mirror image fits, the scan does not: an input error for the caller
  bool no_points =
      false;  ///< an initial pose with too few scan points near the contours: an input error for the caller
  double unit_ratio = 1.0;  ///< not 1: the loops fit when the scan is scaled by this (25.4, 1000, ..)
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// Start pose from nothing: every scan loop laid on every CAD loop; where that leaves much, pieces of the
/// loops; where nothing fits, features of the surface. The best few are refined by a short rigid ICP and
/// scored; the mirror image of the scan is scored as well, and the other side when nothing says which side
/// the scanner saw. The runner-up elsewhere must be clearly worse, unless the motion between the two maps the
/// whole tool path onto itself. Where that motion lays the contours that the scan shows on themselves, and
/// not the path, no score is enough: the scan's edges must tell the two apart. Refuses: nothing to match, no
/// pose that fits, two sides or two poses that fit alike (naming what would decide). Cost: some 10 short ICPs
/// on 250 points; with pieces 5 to 20 times that.
[[nodiscard]] CoarseAlignment coarse_align(const CadModel& cad, const ScanModel& scan,
                                           const CoarseAlignOptions& options);

}  // namespace arris
