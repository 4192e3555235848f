#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "acquisition/contour_extract.hpp"
#include "acquisition/files/file_info.hpp"
#include "acquisition/types/error.hpp"
#include "acquisition/types/frames.hpp"
#include "cli/edge_file.hpp"
#include "cli/key_table.hpp"
#include "registration/edge_calibration.hpp"

namespace arris {

// What --json prints: one object, keys in a fixed order, lengths in mm.

/// {"file", "good", "problems": [{"what", "where", "found", "needed", "next"}]}
[[nodiscard]] std::string problems_json(const std::string& file, const std::vector<ErrorText>& problems);

/// {"file", "contours": [{"id", "points", "length_mm", "closed", "min_bend_radius_mm", "note"}], "dropped":
/// [...]}
[[nodiscard]] std::string contours_json(const std::string& file, const ContourSet& contours);

/// All of FileInfo under its field names, and "file"; lengths in units of the file.
[[nodiscard]] std::string info_json(const std::string& file, const FileInfo& info);

/// {"file", "keys": [{"key", "value", "about", "required", "takes"}]} in the order of the table; a value that
/// is not set, or whose table is `absent`, is null. Paths relative to `folder`; file is null for the
/// defaults.
[[nodiscard]] std::string keys_json(const std::string& file, const std::vector<Key>& keys,
                                    const std::filesystem::path& folder,
                                    const std::set<std::string>& absent = {});

/// {"file", "calibrated", "reason", "edge": {"out_mm", "sd_mm", ..}, "contours": [{"scan", "contour", ..}]}:
/// what arris calibrate edge found; file and edge are null when it was refused.
[[nodiscard]] std::string edge_calibration_json(const std::string& file, const EdgeFile& stored,
                                                const EdgeCalibration& found);

/// {"file", "recipe"}: where a new recipe was written (null: nowhere) and its TOML text.
[[nodiscard]] std::string new_recipe_json(const std::string& file, const std::string& text);

/// `arris map --json`; lengths in mm, file coordinates.
struct MapResult {
  std::string file;
  std::size_t points = 0, on_drawing = 0;
  double mean_mm = 0.0, rms_mm = 0.0, least_mm = 0.0, most_mm = 0.0, in_tolerance_ratio = 0.0;
  RigidMotion scan_from_cad;
  std::vector<std::string> free_directions;
};
[[nodiscard]] std::string map_json(const MapResult& map);

}  // namespace arris
