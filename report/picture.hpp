#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris::report {

enum class Look { kAlong, kOblique };

/// The scan coloured by its deviation, with the found edges, the corrected path (accepted runs only), the
/// worst points by the ids of worst_points(), the run's colour scale and a bar of length: PNG bytes, 1640 px
/// wide. Without any deviation the plain scan is drawn and the title says so. Empty scan: empty string.
[[nodiscard]] std::string deviation_picture(const RunRecord& record, Look look);

/// Nominal path (carried rigidly) and corrected path, the shift drawn larger by a stated factor: PNG bytes.
/// Empty string for a run that is refused or has no path: a path that must not be used is not drawn.
[[nodiscard]] std::string path_shift_picture(const RunRecord& record);

/// The corrected path at true scale with the tool's axes: PNG bytes; empty as above.
[[nodiscard]] std::string path_axes_picture(const RunRecord& record);

/// What `arris contours` shows.
struct ContourDrawing {
  std::string title, subtitle;
  std::vector<Contour> contours;               ///< each in its own colour, with its id and length
  std::vector<Contour> dropped;                ///< thin and grey, without an id
  std::span<const Eigen::Vector3f> points_mm;  ///< drawn light grey; same frame as the contours
  const TriangleMesh* mesh = nullptr;          ///< drawn light grey; may be null
};
/// PNG bytes, seen against the contours' mean normal, or obliquely when the part is far from flat.
[[nodiscard]] std::string contours_picture(const ContourDrawing& drawing);

}  // namespace arris::report
