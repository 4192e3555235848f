#include <fmt/format.h>

#include <Eigen/Core>
#include <fstream>

#include "acquisition/files/read_scan.hpp"
#include "cli/cell.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/json_output.hpp"
#include "cli/recipe.hpp"
#include "cli/recipe_problems.hpp"
#include "cli/text_file.hpp"

namespace arris {
namespace {

RecipeProblems problems_of(const RecipeCheckArgs& args) {
  if (!args.is_cell) return problems_of_recipe(args.file, args.threads);
  return {parse_cell(args.file, read_text_file(args.file, "cell")).problems, {}};
}

/// Largest extent of a mesh along x, y and z, in the file's own units.
Eigen::Vector3d extent_of(const TriangleMesh& mesh) {
  Eigen::Vector3d low = mesh.vertices_mm.front(), high = low;
  for (const Eigen::Vector3d& p : mesh.vertices_mm) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return high - low;
}

std::string new_recipe_text(const RecipeNewArgs& args, const Eigen::Vector3d& extent) {
  const std::filesystem::path folder =
      args.out ? std::filesystem::absolute(*args.out).parent_path() : std::filesystem::current_path();
  const auto path_text = [&](const std::filesystem::path& path) {
    return quote(std::filesystem::absolute(path).lexically_normal().lexically_proximate(folder).string());
  };
  const std::string part = args.part.empty() ? args.cad.stem().string() : args.part;
  std::string text = fmt::format(
      "# Arris recipe. arris recipe print FILE shows every key, its default and what it means.\n"
      "schema = 1\n\n"
      "[part]\nnumber = {}\ncad = {}\n"
      "cad_units = {}  # the mesh measures {:.6g} x {:.6g} x {:.6g} of them: is that the part?\n\n"
      "[scan]\nunits = {}  # of the scan files\n"
      "# seen_from = [0.0, 0.0, 1000.0]  # a point on the air side, scan frame, when scans carry no "
      "normals\n\n",
      quote(part), path_text(args.cad), quote(args.units), extent.x(), extent.y(), extent.z(),
      quote(args.units));
  text += args.path ? fmt::format("[toolpath]\nfile = {}\n\n", path_text(*args.path))
                    : std::string(
                          "[toolpath.from_contour]  # the path runs along the contour of the drawing\n"
                          "offset_mm = 0.0\ndepth_mm = 0.0\n\n");
  return text +
         "[tolerance]  # full widths, from the drawing; 0: none stated, not judged\n"
         "surface_profile_mm = 0.0\ncontour_profile_mm = 0.0\nmax_correction_mm = 20.0  # more is refused\n\n"
         "# [cell]\n# file = \"cell.toml\"  # arris recipe print --cell > cell.toml; without it no robot "
         "program\n";
}

}  // namespace

int run_recipe_check(const RecipeCheckArgs& args) {
  const auto& [problems, remark] = problems_of(args);
  if (args.json)
    console::print(problems_json(args.file.string(), problems));
  else if (problems.empty())
    console::print(args.file.string() + ": good" + (remark.empty() ? "" : ", " + remark));
  if (problems.empty()) return 0;
  if (!args.json)
    for (const ErrorText& problem : problems) console::complain(to_line(problem));
  return exit_code(Fault::kRecipe);
}

int run_recipe_print(const RecipePrintArgs& args) {
  const std::filesystem::path folder = args.file ? args.file->parent_path() : std::filesystem::path();
  const std::string name = args.file ? args.file->string() : std::string();
  std::string text;
  if (!args.is_cell) {
    Recipe recipe = args.file ? read_recipe(*args.file) : Recipe();
    text = args.json ? keys_json(name, recipe_keys(recipe), folder, absent_tables(recipe))
                     : print_recipe(recipe, folder);
  } else {
    CellFile cell = args.file ? read_good_cell(*args.file).file : CellFile();
    text = args.json ? keys_json(name, cell_keys(cell), folder) : print_cell(cell, folder);
  }
  if (text.ends_with('\n')) text.pop_back();  // print() ends the last line
  console::print(text);
  return 0;
}

int run_recipe_new(const RecipeNewArgs& args) {
  const TriangleMesh cad = read_mesh(args.cad);
  if (args.path && !std::filesystem::exists(*args.path))
    throw Error(Fault::kInput, {.what = "there is no such tool path",
                                .where = args.path->string(),
                                .found = "nothing of that name",
                                .needed = "a file of rows x,y,z,nx,ny,nz",
                                .next = "check the name"});
  std::string text = new_recipe_text(args, extent_of(cad));
  if (args.out) write_new_text_file(*args.out, text, "recipe");
  if (args.json) {
    console::print(new_recipe_json(args.out ? args.out->string() : std::string(), text));
  } else if (args.out) {
    console::print("wrote " + args.out->string() + "; next: arris recipe check " + args.out->string());
  } else {
    text.pop_back();
    console::print(text);
  }
  return 0;
}

}  // namespace arris
