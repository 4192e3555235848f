#include "registration/pose_watch.hpp"

#include <algorithm>

namespace arris {

double PoseWatch::times_worse(const RigidMotion& scan_from_cad) const {
  return score_.of(scan_, scan_from_cad).patient_mm / std::max(found_mm_, scan_.model.spacing_mm);
}

}  // namespace arris
