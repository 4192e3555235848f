#pragma once

#include "registration/pose_score.hpp"

namespace arris {

/// What two poses of a deformed part may differ by without a scan telling them apart.
struct PoseTolerance {
  double in_face_mm = 0.0;  ///< what spacing and strain leave open
  double height_mm = 0.0;   ///< what bending leaves open
};

/// Of a scan with this spacing, of a part whose largest contour has this size; a pose is a fit while it
/// leaves no more than fits_mm.
[[nodiscard]] PoseTolerance pose_tolerance(double spacing_mm, double size_mm, double fits_mm);

/// Whether a motion of the drawing, known to within_mm, lays most of what the scan shows of its contours, at
/// the pose taken, on contours of the drawing.
[[nodiscard]] bool lays_shown_on_itself(const CadModel& cad, const LightScan& scan, const RigidMotion& taken,
                                        const RigidMotion& motion, const PoseTolerance& tolerance,
                                        double within_mm);

/// Whether the scan's edges tell two poses of the drawing apart: somewhere along a contour, followed or not,
/// the two put different edges beyond the tolerance, and there the scan shows the edge of the pose taken and
/// not that of the other. Where the poses put the same edges a part may be bent or a scan noisy so that one
/// fits better: that tells nothing. Both poses fitted to the end, the scan with the side of the two.
/// Cost: some 200 nearest points and contours for each contour.
[[nodiscard]] bool edges_tell_apart(const CadModel& cad, const LightScan& scan, const RigidMotion& taken,
                                    const RigidMotion& other, const PoseTolerance& tolerance);

}  // namespace arris
