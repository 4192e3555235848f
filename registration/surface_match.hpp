#pragma once

#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/scene.hpp"

namespace arris {

/// Start poses from the shape of the surface alone, for scans that show no contour whole: the last resort.
/// Points of the drawing within band_mm of the contours and of the scan get FPFH descriptors; pairs that look
/// alike are kept where they agree with each other in their distances and normals, and of the largest groups
/// that agree the motion is fitted with weights made sharper step by step. No random numbers.
///   spacing_mm  of the scan's points as given, which may be thinned
///   returns  motions scan_from_cad, those with most support first; none where the surface has too little
///            shape: a plane, a cylinder or a sphere looks the same everywhere
///   source   FPFH: Rusu et al., ICRA 2009; groups: Chen et al., SC2-PCR, CVPR 2022; fit: Yang et al., GNC,
///            RA-L 5(2), 2020
///   cost     some 50 ms at 700 points a side
[[nodiscard]] std::vector<RigidMotion> match_surfaces(const CadModel& cad, const ScanModel& scan,
                                                      double spacing_mm, double band_mm, int threads);

}  // namespace arris
