#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "acquisition/geometry/surface_query.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// Signed distance of every scan point to the CAD surface, positive outside the material; mm.
///   NaN   farther than reach_mm, or the nearest place is the border of an open CAD (that is a distance to an
///   edge)
/// Cost O(N log n), much alike for points in any order; 20 MB beside the answer; same bytes for any thread
/// count.
[[nodiscard]] std::vector<float> signed_deviation_mm(const SurfaceQuery& cad,
                                                     const RigidMotion& scan_from_cad,
                                                     std::span<const Eigen::Vector3f> points_mm,
                                                     double reach_mm, int threads);

}  // namespace arris
