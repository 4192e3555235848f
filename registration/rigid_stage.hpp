#pragma once

#include <vector>

#include "registration/found_edge.hpp"
#include "registration/pose_watch.hpp"
#include "registration/registration.hpp"

namespace arris {

/// Rigid ICP, from the start pose on the scan's extracted edge points and then once more on the edge by
/// support. Extracted points end up to a spacing inside the material, of a scan in rows up to the distance of
/// the rows, and not alike all around: a pose from them slides along an oval. Strays and the rims of gaps are
/// extracted as well. Where they led the fit to a place that the whole scan belies, the edge by support is
/// taken from the start pose on; the fit never ends where the watch calls it astray.
///   result.rigid   the pose with its covariance, of which what is unknown of the edge across is a part
///   returns        the edges relative to it, one a contour of `cad`; empty where there is no pose, and with
///                  method surface, which finds its own
[[nodiscard]] std::vector<ContourResult> rigid_stage(const CadModel& cad, const ScanModel& scan,
                                                     const RegistrationOptions& options,
                                                     const PoseWatch& watch, Registration& result);

}  // namespace arris
