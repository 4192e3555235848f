#pragma once

#include "registration/registration.hpp"
#include "report/run_record.hpp"

namespace arris {

/// Fills the three results of a run that has a pose: contour errors, statistics, limits and judgements.
///   (ii)  the whole scan after the rigid alignment: judged when the part is free, shown when it is clamped
///   (iii) the found edge against the nominal contour carried by the field: judged when the part is clamped
/// Expanded uncertainties (k = 2) of y = 2 max|d|: (ii) from the scanner's noise, (iii) from the edge fit.
/// The scanner's own calibration is not known here, and the texts say so.
void judge_results(const CadModel& cad, const Registration& found, RunRecord& record);

}  // namespace arris
