#include "cli/recipe_problems.hpp"

#include <algorithm>
#include <utility>

#include "cli/cell.hpp"
#include "cli/drawing.hpp"
#include "cli/edge_file.hpp"
#include "cli/recipe.hpp"
#include "cli/recipe_options.hpp"
#include "cli/text_file.hpp"
#include "toolpath/correct.hpp"
#include "toolpath/formats/csv.hpp"
#include "toolpath/robot/dialect.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;

/// What a step throws becomes a problem; two steps that meet the same one give it once.
template <class Step>
void collect(std::vector<ErrorText>& problems, const Step& step) {
  try {
    step();
  } catch (const Error& error) {
    if (error.fault() == Fault::kInterrupted || error.fault() == Fault::kBug) throw;
    const auto known = [&](const ErrorText& problem) { return to_line(problem) == error.what(); };
    if (std::none_of(problems.begin(), problems.end(), known)) problems.push_back(error.text());
  }
}

/// Names the files that are missing; true when those of drawing and path are there.
bool files_are_there(const fs::path& file, const Recipe& recipe, std::vector<ErrorText>& problems) {
  const std::size_t before = problems.size();
  const auto check = [&](const fs::path& named, const std::string& key) {
    if (named.empty() || fs::exists(named)) return;
    problems.push_back({.what = "there is no such file",
                        .where = file.string() + ", " + key,
                        .found = named.string(),
                        .needed = "a file that exists, its path relative to the recipe",
                        .next = "check the name"});
  };
  check(recipe.part.cad, "part.cad");
  check(recipe.contour.file, "contour.file");
  check(recipe.toolpath.file, "toolpath.file");
  const bool there = problems.size() == before;
  check(recipe.scan.edge_calibration, "scan.edge_calibration");
  check(recipe.cell, "cell.file");
  return there;
}

void check_cell_of(const Recipe& recipe, std::vector<ErrorText>& problems) {
  if (recipe.cell.empty() || !fs::exists(recipe.cell)) return;
  CellRead read = parse_cell(recipe.cell, read_text_file(recipe.cell, "cell"));
  if (read.problems.empty())
    collect(problems, [&] { check_cell(dialect_from_name(recipe.robot.controller), read.cell); });
  for (ErrorText& problem : read.problems) problems.push_back(std::move(problem));
}

void check_edge_calibration_of(const Recipe& recipe, std::vector<ErrorText>& problems) {
  const fs::path& file = recipe.scan.edge_calibration;
  if (file.empty() || !fs::exists(file)) return;
  collect(problems, [&] {
    for (ErrorText& problem : parse_edge_file(file, read_edge_text(file)).problems)
      problems.push_back(std::move(problem));
  });
}

/// The path alone first: a drawing that is refused must not hide what is wrong in the path.
void check_drawing_of(const Recipe& recipe, bool has_path, int threads, std::vector<ErrorText>& problems) {
  const fs::path& path = recipe.toolpath.file;
  if (!path.empty())
    collect(problems, [&] { (void)read_path_csv(read_text_file(path, "tool path"), path.string()); });
  collect(problems, [&] {
    const Drawing drawing = read_drawing(recipe, has_path, threads);
    if (!has_path) return;
    Recipe measured = recipe;
    measured.part.thickness_mm = drawing.thickness_mm;  // a solid says it itself
    check_path_belongs(drawing.path, SurfaceQuery(drawing.mesh), correct_options(measured, threads));
  });
}

}  // namespace

RecipeProblems problems_of_recipe(const fs::path& file, int threads) {
  RecipeRead read = parse_recipe(file, read_text_file(file, "recipe"));
  const Recipe& recipe = read.recipe;
  RecipeProblems found{std::move(read.problems), {}};
  const bool keys_are_good = found.problems.empty();
  const bool has_path = !recipe.toolpath.file.empty() || recipe.toolpath.from_contour.given;
  if (files_are_there(file, recipe, found.problems) && keys_are_good)
    check_drawing_of(recipe, has_path, threads, found.problems);
  check_edge_calibration_of(recipe, found.problems);
  check_cell_of(recipe, found.problems);
  if (!has_path) found.remark = "for arris inspect alone: it names no tool path";
  return found;
}

}  // namespace arris
