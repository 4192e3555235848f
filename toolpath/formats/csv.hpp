#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/correct.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// A tool path as its file gave it.
struct PathCsv {
  ToolPath path;
  std::vector<std::string> notes;  ///< liberties the reader took: separators, axes brought to length 1
};

/// Reads a tool path CSV: a header with x,y,z,nx,ny,nz (mm, axis out of the material)
/// and any of path, feed_mm_s, closed, index in any order; or no header and 6 or 7 (index first) numbers a
/// line. '#' comments, blank lines; a line with text in its first field alone (" Line 1,,,,,,") starts a new
/// polyline.
///   source   the file's name, for messages
///   throws   Error(kInput) with the line: unknown column (with the nearest known), missing column, wrong
///   number of
///            fields, not a number, not finite, an axis off length 1 by more than 1 %, a polyline that is
///            taken up again after another, a negative feed, a path that is corrected already (a result_hash
///            or shift columns)
///   cost     O(size); C locale always
[[nodiscard]] PathCsv read_path_csv(std::string_view text, const std::string& source);

/// The nominal path as CSV, in its own columns; 6 decimals.
[[nodiscard]] std::string write_path_csv(const ToolPath& path);

/// corrected.csv of a run folder: the result hash as a comment, then the nominal columns in their order with
/// the corrected values, then shift_mm, shift_normal_mm, shift_across_mm, sd_normal_mm, sd_across_mm,
/// sd_along_mm, sd_axis_deg, source (data or prior). 6 decimals; sd 0 is unknown.
///   offset_mm   the scan's ingest offset, added to every tip
///   throws      Error(kBug) for a correction that is not accepted or belongs to another path
[[nodiscard]] std::string write_corrected_csv(const ToolPath& nominal, const Correction& correction,
                                              const Eigen::Vector3d& offset_mm,
                                              const std::string& result_hash);

}  // namespace arris
