#pragma once

#include "registration/registration.hpp"

namespace arris {

/// Mean strain along the contours: at the mid-surface (options.mid_depth_mm below the scanned face) and on
/// the face, and what of it the scan cannot tell. Method rigid looks for none; role cut has no rim that could
/// be longer than drawn, and no limit.
void measure_strain(const CadModel& cad, const RegistrationOptions& options, Registration& result);

}  // namespace arris
