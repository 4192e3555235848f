#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/cmd_run.hpp"

namespace arris {

/// `arris contours FILE`: lists, draws and chooses contours.
struct ContoursArgs {
  std::filesystem::path file;
  std::optional<std::filesystem::path> recipe, out, png;
  std::vector<int> accept;  ///< ids the operator accepts; the others are rejected
  std::string units;        ///< of the file, when no recipe says; empty: mm
  bool json = false;
  int threads = 0;
};
[[nodiscard]] int run_contours(const ContoursArgs& args);

/// `arris calibrate edge RECIPE`: where a scanner shows edges, from scans of a reference of known size.
struct CalibrateEdgeArgs {
  std::filesystem::path recipe;  ///< of the reference
  std::vector<std::filesystem::path> scans;
  std::string scanner, serial;
  double size_sd_mm = 0.01;   ///< how well the reference's size is known
  std::filesystem::path out;  ///< where the calibration is written
  bool force = false;         ///< a former calibration of that name is replaced
  bool json = false;
  int threads = 0;
};
/// Returns 0, or 5 when the scans support no calibration; then nothing is written.
[[nodiscard]] int run_calibrate_edge(const CalibrateEdgeArgs& args);

/// `arris info FILE`
struct InfoArgs {
  std::filesystem::path file;
  bool json = false;
};
[[nodiscard]] int run_info(const InfoArgs& args);

/// `arris map RECIPE --scan FILE`: the whole scan laid on the drawing, and the deviation of every point.
struct MapArgs {
  std::filesystem::path recipe, scan;
  std::optional<std::filesystem::path> out;  ///< none: <scan stem>.map.ply
  bool json = false;
  int threads = 0;
};
/// Throws Error(kInput) for what keeps the scan from being laid on the drawing; judges nothing.
[[nodiscard]] int run_map(const MapArgs& args);

/// `arris recipe check|print|new`
struct RecipeCheckArgs {
  std::filesystem::path file;
  bool is_cell = false;
  bool json = false;
  int threads = 0;
};
[[nodiscard]] int run_recipe_check(const RecipeCheckArgs& args);

struct RecipePrintArgs {
  std::optional<std::filesystem::path> file;  ///< none: the defaults
  bool is_cell = false;
  bool json = false;
};
[[nodiscard]] int run_recipe_print(const RecipePrintArgs& args);

struct RecipeNewArgs {
  std::filesystem::path cad;
  std::optional<std::filesystem::path> path, out;  ///< out: where the recipe is written; none: stdout
  std::string part, units = "mm";
  bool json = false;
};
[[nodiscard]] int run_recipe_new(const RecipeNewArgs& args);

/// `arris demo`
struct DemoArgs {
  std::filesystem::path out = "arris-demo";
  std::string part = "porthole";
  bool json = false;
  int threads = 0;
};
[[nodiscard]] int run_demo(const DemoArgs& args);

/// `arris batch`: many scans with one recipe, each in a process of its own.
struct BatchArgs {
  std::filesystem::path recipe;
  std::vector<std::string> scans;                  ///< files, folders, @list.txt
  std::optional<std::filesystem::path> out, cell;  ///< none: <recipe stem>.batch; the recipe's
  bool inspect_only = false;
  bool force = false;  ///< run again what is complete
  bool json = false;
  int jobs = 0;       ///< processes at a time; 0: one a core
  int threads = 0;    ///< of each process; 0: one
  int timeout_s = 0;  ///< of each process, which is killed then; 0: none
};
/// Returns the worst exit code of its scans; throws Error(kInput) for what keeps all of them from running.
[[nodiscard]] int run_batch(const BatchArgs& args);

}  // namespace arris
