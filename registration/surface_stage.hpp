#pragma once

#include "registration/registration.hpp"

namespace arris {

/// The last stage of method surface: the field, the found edge relative to it (what is left is the part's own
/// error), mean strain, and what makes the contours' place unknown: a standard deviation across over
/// options.max_sd_mm is refused, with the motion that nothing holds where the whole contour slides.
/// Role cut: no edge is looked for along the accepted contours.
void deform_by_surface(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
                       Registration& result);

}  // namespace arris
