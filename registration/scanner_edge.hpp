#pragma once

namespace arris {

/// How a scanner shows an edge: a property of the scanner and its settings, of either sign (laser flyers
/// beyond the edge, a spot that loses the last points before it, a mesh that closes over it). From a
/// reference of known size (calibrate_edge); the size of a drawn hole is never evidence for it, for that may
/// be the part's own error.
struct ScannerEdge {
  static constexpr double kUncalibratedSdMm = 0.05;  // hand scanners: a tenth of a millimetre either way
  static constexpr double kMostOutMm = 2.0;          // farther out it is something else
  double out_mm = 0.0;               ///< edges are shown this far out in the void; negative: in the material
  double sd_mm = kUncalibratedSdMm;  ///< standard deviation of out_mm: no edge is known better across
};

}  // namespace arris
