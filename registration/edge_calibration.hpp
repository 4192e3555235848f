#pragma once

#include <span>
#include <string>
#include <vector>

#include "registration/registration.hpp"
#include "registration/scanner_edge.hpp"

namespace arris {

struct EdgeCalibrationOptions {
  double size_sd_mm = 0.01;  ///< how well the size of the reference is known, edge to edge of the material
};

/// What the scans of a reference say of one contour.
struct CalibratedContour {
  std::size_t scan = 0;  ///< of the scans given
  int id = 0;            ///< of the contour
  double seen_ratio = 0.0;
  std::size_t stretches = 0;  ///< pieces of about 50 mm
  double out_mm = 0.0;        ///< mean over the contour
  double scatter_mm = 0.0;    ///< standard deviation of its stretches about that mean
  bool used = false;          ///< false: too little of it was seen
};

/// A scanner's edge from a reference of known size.
struct EdgeCalibration {
  ScannerEdge edge;
  std::vector<CalibratedContour> contours;
  std::size_t stretches = 0;  ///< of edge that were averaged
  double scatter_mm = 0.0;    ///< standard deviation of all stretches about their contour's mean
  std::string reason;         ///< why there is no calibration; empty when usable
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// The mean distance, all round, of the edges that the scans show from the drawn ones, after a rigid
/// alignment. Around a closed contour a shift of the alignment averages out, so the size of the reference
/// alone decides. Its standard deviation holds the scatter of the stretches, the reference's size, and what
/// the fit itself does to an edge at the scans' spacing. A hole and an outline that are both used tell a
/// wrong size from a wrong scanner.
///   scans    of the reference, registered with method rigid and a ScannerEdge of zero
///   refuses  no contour that was seen all round; a reference that is bent or not as drawn (height or edge
///            wander along a contour, or contours disagree); a result no better than an uncalibrated scanner
[[nodiscard]] EdgeCalibration calibrate_edge(const CadModel& cad, std::span<const Registration> scans,
                                             const EdgeCalibrationOptions& options);

}  // namespace arris
