#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/key_table.hpp"
#include "registration/scanner_edge.hpp"

namespace arris {

/// What `arris calibrate edge` stores of a scanner: where it shows edges, and from which files that is known.
struct EdgeFile {
  int schema = 1;
  std::string scanner, serial;           ///< as people call it; its serial number, empty: none given
  ScannerEdge edge;                      ///< positive: shown too far out, in the void
  double spacing_mm = 0.0;               ///< of the points of the reference's scans
  std::string date;                      ///< of the reference's scans, YYYY-MM-DD
  std::string recipe_sha256;             ///< of the reference's recipe,
  std::string cad_sha256;                ///< drawing
  std::vector<std::string> scan_sha256;  ///< and scans; lower-case hex
};

/// The one table of keys of such a file, bound to `file`; valid while it lives.
[[nodiscard]] std::vector<Key> edge_keys(EdgeFile& file);

/// A file with all that is wrong in it; problems empty: good.
struct EdgeFileRead {
  EdgeFile file;
  std::vector<ErrorText> problems;
};

/// Reads and checks text as if it stood in `file`.
[[nodiscard]] EdgeFileRead parse_edge_file(const std::filesystem::path& file, const std::string& text);

/// The text of a calibration. Throws Error(kInput): missing, or larger than any calibration.
[[nodiscard]] std::string read_edge_text(const std::filesystem::path& file);

/// Reads one that must be good. Throws Error(kInput) as read_edge_text(), Error(kRecipe) with the first
/// problem in it.
[[nodiscard]] EdgeFile read_edge_file(const std::filesystem::path& file);

/// The full TOML: every key with its value, commented. parse_edge_file() reads it back.
[[nodiscard]] std::string print_edge_file(const EdgeFile& file);

/// Why a scanner cannot have this name or serial number; empty: it can. Reports and screens show both.
[[nodiscard]] std::string why_no_name(const std::string& name);

}  // namespace arris
