#pragma once

#include <filesystem>
#include <optional>

namespace arris {

/// What `arris run`, `arris inspect` and `arris demo` were asked for.
struct RunArgs {
  std::filesystem::path recipe, scan;
  std::optional<std::filesystem::path> out, contours, cell;  ///< none: <scan stem>.arris; found; the recipe's
  std::optional<std::filesystem::path> targets;  ///< points of fixture targets that the scanner gave
  bool force = false;                            ///< replace an existing run folder
  bool inspect_only = false;                     ///< no tool path: shape and contours alone
  bool json = false;                             ///< the outcome as JSON on stdout
  int threads = 0;                               ///< 0: all cores
};

/// The main job, from files to a complete run folder. Prints through cli/console.
///   returns  the exit code: 0 in tolerance, 4 out of tolerance, 5 refused, 7 indeterminate
///   throws   Error for what cannot be done; no folder is left then
[[nodiscard]] int run_main_job(const RunArgs& args);

}  // namespace arris
