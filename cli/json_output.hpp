#pragma once

#include <string>
#include <vector>

#include "acquisition/contour_extract.hpp"
#include "acquisition/files/file_info.hpp"
#include "acquisition/types/error.hpp"

namespace arris {

// What --json prints: one object, keys in a fixed order, lengths in mm.

/// {"file", "good", "problems": [{"what", "where", "found", "needed", "next"}]}
[[nodiscard]] std::string problems_json(const std::string& file, const std::vector<ErrorText>& problems);

/// {"file", "contours": [{"id", "points", "length_mm", "closed", "min_bend_radius_mm", "note"}], "dropped":
/// [...]}
[[nodiscard]] std::string contours_json(const std::string& file, const ContourSet& contours);

/// All of FileInfo under its field names, and "file"; lengths in units of the file.
[[nodiscard]] std::string info_json(const std::string& file, const FileInfo& info);

}  // namespace arris
