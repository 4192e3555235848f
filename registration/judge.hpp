#pragma once

#include "registration/pose_watch.hpp"
#include "registration/registration.hpp"

namespace arris {

/// Each adds to result.refusals, in plain words, why the result is not to be trusted.

/// Contours of which the scan shows too little, or on too long a stretch none, or only rows along the edge.
void judge_coverage(const CadModel& cad, const RegistrationOptions& options, Registration& result);

/// Where two neighbouring segments disagree about the place of their common cut, one of them is wrong.
void judge_seams(const CadModel& cad, Registration& result);

/// Robust residual normal to the surface up to which noise and the method explain it; mm.
[[nodiscard]] double explained_residual_mm(const ScanModel& scan);

/// Heights beside the edge that scatter far more than the scanner's noise are not explained by the field.
void judge_residuals(const CadModel& cad, const ScanModel& scan, Registration& result);

/// A contour that comes out so much longer or shorter than drawn as no part on a fixture is.
void judge_strain(Registration& result);

/// A method bends a part and does not move it: the rigid motion nearest to where it carries the contours must
/// fit the whole scan about as well as the pose that was found.
void judge_moved(const CadModel& cad, const PoseWatch& watch, Registration& result);

/// What a projection leaves beyond its limit, on the surface and in it. Across the edge it is also allowed
/// what a scan of this density cannot show.
void judge_projection(const CadModel& cad, const ProjectionOptions& options, Registration& result);

}  // namespace arris
