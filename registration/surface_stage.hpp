#pragma once

#include "registration/registration.hpp"

namespace arris {

/// The last stage of method surface: the field, the found edge relative to it (what is left is the part's own
/// error), mean strain, and what makes the contours' place unknown: a standard deviation across over
/// options.max_sd_mm is refused, with the motion that nothing holds where the whole contour slides.
/// Role cut: no edge is looked for along the accepted contours.
void deform_by_surface(const CadModel& cad, const ScanModel& scan, const RegistrationOptions& options,
                       Registration& result);

/// Whether a move of the part by so much, after which its edges would be seen much better, says that the fit
/// slid: at least 4 mm and 1.5 point spacings. Less is within what a scan shows of an edge.
[[nodiscard]] bool is_slide(double moved_mm, double spacing_mm);

}  // namespace arris
