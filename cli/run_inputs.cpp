#include "cli/run_inputs.hpp"

#include "acquisition/files/sha256.hpp"
#include "acquisition/types/error.hpp"
#include "toolpath/robot/dialect.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> cell_file(const RunArgs& args, const Recipe& recipe) {
  if (args.cell) return args.cell;
  if (!recipe.cell.empty()) return recipe.cell;
  return std::nullopt;
}

}  // namespace

std::optional<Cell> read_cell_for(const RunArgs& args, const Recipe& recipe) {
  const std::optional<fs::path> file = cell_file(args, recipe);
  std::optional<Cell> cell;
  if (args.inspect_only && file && !args.cell && !fs::exists(*file)) return cell;  // it needs no cell
  if (file) cell = read_cell(*file);
  if (args.inspect_only && cell && cell->targets.empty()) cell.reset();
  if (args.targets && (!cell || cell->targets.empty()))
    throw Error(Fault::kInput, {.what = "--targets is given, and the cell has no fixture targets",
                                .where = file ? file->string() : "no cell",
                                .needed = "a cell with scan_reference = \"targets\"",
                                .next = "leave --targets out, or give that cell with --cell"});
  if (cell && !args.inspect_only) check_cell(dialect_from_name(recipe.robot.controller), *cell);
  return cell;
}

InputFile hashed_input(const char* role, const fs::path& file) {
  return {role, file.filename().string(), sha256_file(file)};
}

std::vector<InputFile> hashed_inputs_but_scan(const RunArgs& args, const Recipe& recipe,
                                              const std::optional<Cell>& cell) {
  std::vector<InputFile> inputs;
  const auto add = [&](const char* role, const fs::path& file) {
    if (!file.empty()) inputs.push_back(hashed_input(role, file));
  };
  add("cad", recipe.part.cad);
  add("recipe", args.recipe);
  if (!args.inspect_only) add("path", recipe.toolpath.file);
  add("contour", recipe.contour.file);
  add("edge_calibration", recipe.scan.edge_calibration);
  if (cell) {
    add("cell", *cell_file(args, recipe));
    add("references", cell->targets_file);
  }
  if (args.targets) add("targets", *args.targets);
  if (args.contours) add("contours", *args.contours);
  return inputs;
}

std::vector<InputFile> hashed_inputs(const RunArgs& args, const Recipe& recipe,
                                     const std::optional<Cell>& cell) {
  std::vector<InputFile> inputs = hashed_inputs_but_scan(args, recipe, cell);
  inputs.insert(inputs.begin(), hashed_input("scan", args.scan));
  return inputs;
}

}  // namespace arris
