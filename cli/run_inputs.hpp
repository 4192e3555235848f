#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "cli/cell.hpp"
#include "cli/cmd_run.hpp"
#include "cli/recipe.hpp"
#include "report/run_record.hpp"

namespace arris {

/// The cell as far as a run needs it, checked against the robot's language: --cell, else the recipe's. An
/// inspection looks for its fixture targets, to leave them out, and takes a cell without them for none.
///   throws  Error(kInput, kRecipe): the cell cannot be read or used; --targets without fixture targets
[[nodiscard]] std::optional<Cell> read_cell_for(const RunArgs& args, const Recipe& recipe);

/// A file that takes part, with its hash. Throws Error(kInput) when it cannot be read.
[[nodiscard]] InputFile hashed_input(const char* role, const std::filesystem::path& file);

/// Every file but the scan that decides what a run finds, with its hash.
///   cell    as read_cell_for gives it
///   throws  Error(kInput): one of them cannot be read
[[nodiscard]] std::vector<InputFile> hashed_inputs_but_scan(const RunArgs& args, const Recipe& recipe,
                                                            const std::optional<Cell>& cell);

/// All of them, the scan first: the order of result.json.
[[nodiscard]] std::vector<InputFile> hashed_inputs(const RunArgs& args, const Recipe& recipe,
                                                   const std::optional<Cell>& cell);

}  // namespace arris
