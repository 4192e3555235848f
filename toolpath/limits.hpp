#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "toolpath/correct.hpp"

namespace arris {

/// Rows of a path that share a fault, as people read them: "rows 120 to 180 (s = 240.0 to 360.0 mm)", rows
/// from 1, "path 2, rows 7 to 9 (...)" when there are several polylines; one entry a run of consecutive rows
/// of a polyline.
///   over(i)   how bad row i is, or nothing; the worst of a run is handed to `say`
///   returns   "rows ...: <say(worst)>", at most 20 runs and one line that counts the others
[[nodiscard]] std::vector<std::string> list_rows(
    const ToolPath& nominal, const std::function<std::optional<double>(std::size_t)>& over,
    const std::function<std::string(double)>& say);

/// Judges shift, tilt and step of a corrected path against its limits; empty when all hold.
///   rotations   the field's rotation of each row's anchor; carries the nominal step that the corrected one
///   is held to
[[nodiscard]] std::vector<std::string> limits_broken(const ToolPath& nominal, const Correction& correction,
                                                     const std::vector<Eigen::Matrix3d>& rotations,
                                                     const CorrectOptions& options);

}  // namespace arris
