#pragma once

#include <string>
#include <vector>

#include "registration/scanner_edge.hpp"

namespace arris {

/// Where the scanner shows edges, as far as the run knows.
struct EdgeOffset {
  bool calibrated = false;
  ScannerEdge edge;             ///< without a calibration: zero, and its standard deviation
  double spacing_mm = 0.0;      ///< of the points of the calibration's scans
  std::string date;             ///< of them, YYYY-MM-DD
  std::string scanner, serial;  ///< empty serial: not given
};

namespace report {

/// "calibrated 2026-11-20, +0.030 ± 0.010 mm, scanner NAME", or that it is not.
[[nodiscard]] std::string edge_offset_text(const EdgeOffset& offset);

/// What may be doubted in a calibration: scans of other spacing, more than a year before the scan.
///   spacing_mm   of this scan's points
///   report_time  date of this scan, ISO 8601
[[nodiscard]] std::vector<std::string> edge_offset_notes(const EdgeOffset& offset, double spacing_mm,
                                                         const std::string& report_time);

}  // namespace report
}  // namespace arris
