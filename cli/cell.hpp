#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/key_table.hpp"
#include "toolpath/robot/cell.hpp"

namespace arris {

/// A cell as its TOML file spells it: quaternions as numbers, degrees. cell_of() makes the Cell.
struct CellFile {
  struct Pose {
    std::vector<double> xyz_mm, quat_wxyz;
  };
  Pose robot_from_scan, robot_from_work{{0, 0, 0}, {1, 0, 0, 0}}, flange_from_tool{{0, 0, 0}, {1, 0, 0, 0}};
  std::string scan_reference = "fixed";
  std::filesystem::path references;
  std::vector<double> tool_centre_mm = {0, 0, 50};
  double turn_speed_deg_s = 45.0;
  Cell cell;  ///< the fields that are spelt alike
};

/// The one table of keys of a cell, bound to `file`; valid while it lives. Which keys must be given depends
/// on file.scan_reference: robot_from_scan of a mounted scanner, references of one with targets.
[[nodiscard]] std::vector<Key> cell_keys(CellFile& file);

/// A cell with all that is wrong in it; problems empty: good.
struct CellRead {
  CellFile file;
  Cell cell;
  std::vector<ErrorText> problems;
};

/// Reads and checks text as if it stood in `file`.
[[nodiscard]] CellRead parse_cell(const std::filesystem::path& file, const std::string& text);

/// Reads a cell that must be good. Throws Error(kInput) when the file cannot be read, Error(kRecipe) with the
/// first problem in it.
[[nodiscard]] CellRead read_good_cell(const std::filesystem::path& file);
[[nodiscard]] Cell read_cell(const std::filesystem::path& file);

/// The full TOML of a cell: every key with its value, commented. Paths are written relative to `folder`.
[[nodiscard]] std::string print_cell(const CellFile& file, const std::filesystem::path& folder = {});

}  // namespace arris
