#pragma once

#include <cstddef>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/light_scan.hpp"
#include "registration/scene.hpp"

namespace arris {

/// Starts that need no loop of the scan, nor a piece of one: the drawing's contours laid flat on each of the
/// scan's largest faces, with every turn and every shift that leaves their middle among its edges. Best first
/// by face: the least mean square distance from the nearest edge whose material lies on the same side, no
/// single one over cap_mm; at most `count` a face, cap_mm apart. A branch and bound over shifts on grids of
/// least distances (Olson, IEEE ICRA 2009): some 0.1 s a face and 20 MB.
[[nodiscard]] std::vector<RigidMotion> match_faces(const CadModel& cad, const ScanModel& scan, double cap_mm,
                                                   std::size_t count, int threads);

}  // namespace arris
