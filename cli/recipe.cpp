#include "cli/recipe.hpp"

#include <algorithm>

#include "cli/recipe_options.hpp"
#include "cli/text_file.hpp"

namespace arris {
namespace {

const std::set<std::string> kPresenceTables = {"scan.initial", "toolpath.from_contour"};

/// What no single key can say: combinations. Where is the table they stand in.
void check_together(const std::filesystem::path& file, const Recipe& recipe,
                    std::vector<ErrorText>& problems) {
  const auto where = [&](const std::string& table) { return file.string() + ", [" + table + "]"; };
  const auto add = [&](ErrorText problem) { problems.push_back(std::move(problem)); };
  if (!recipe.toolpath.file.empty() && recipe.toolpath.from_contour.given)
    add({"the tool path is given twice", where("toolpath"), "file and from_contour", "one of them",
         "remove [toolpath.from_contour] or toolpath.file"});
  if (recipe.scan.initial.given && recipe.scan.initial.scan_from_cad.empty())
    add({"scan.initial has no pose", where("scan.initial"), "no scan_from_cad",
         "scan_from_cad, 16, 12 or 7 numbers", "add it, or remove [scan.initial]"});
  else if (recipe.scan.initial.given) {
    try {
      (void)motion_from_numbers("scan.initial.scan_from_cad", recipe.scan.initial.scan_from_cad);
    } catch (const Error& error) {
      ErrorText problem = error.text();
      problem.where = where("scan.initial");
      problem.next = "correct it, or remove [scan.initial]";
      add(problem);
    }
  }
  const bool moved = recipe.part.cad_is == "other_face" || recipe.part.cad_is == "mid";
  const bool far = recipe.toolpath.face == "other" && recipe.part.cad_is != "solid";
  if ((moved || far) && recipe.part.thickness_mm.value_or(0.0) <= 0.0)
    add({"the thickness of the part is missing", where("part"),
         moved ? "cad_is = \"" + recipe.part.cad_is + "\"" : "toolpath.face = \"other\"",
         "part.thickness_mm, more than 0", "write the thickness of the sheet into the recipe"});
  for (const int id : recipe.contour.accept)
    if (std::find(recipe.contour.reject.begin(), recipe.contour.reject.end(), id) !=
        recipe.contour.reject.end())
      add({"contour " + std::to_string(id) + " is both accepted and rejected", where("contour"),
           "it in both lists", "it in one of them", "remove it from contour.accept or contour.reject"});
  if (recipe.registration.subdivision.refine != "none" && recipe.registration.method != "subdivision")
    add({"the joint fit belongs to method = \"subdivision\"", where("registration.subdivision"),
         "method = \"" + recipe.registration.method + "\"", "refine = \"none\", or method = \"subdivision\"",
         "change one of them"});
  const auto& subdivision = recipe.registration.subdivision;
  const std::string fitting = subdivision.match == "paper" ? "paper" : "local";
  if (subdivision.stability_points != "none" && subdivision.stability_points != fitting)
    add({"these stability points have no effect with this matching", where("registration.subdivision"),
         "match = \"" + subdivision.match + "\", stability_points = \"" + subdivision.stability_points + "\"",
         "stability_points = \"" + fitting + "\" or \"none\"", "change it"});
  if (recipe.contour.role == "cut" && recipe.registration.method != "surface")
    add({"role = \"cut\" needs the surface field", where("registration"),
         "method = \"" + recipe.registration.method + "\", which follows edges that are not there yet",
         "method = \"surface\"", "change registration.method, or contour.role"});
  if (recipe.contour.stock_mm > 0.0 && recipe.contour.role == "edge")
    add({"contour.stock_mm belongs to role = \"cut\"", where("contour"), "stock_mm with role = \"edge\"",
         "stock_mm = 0 with role = \"edge\"", "leave stock_mm out, or change contour.role"});
}

}  // namespace

RecipeRead parse_recipe(const std::filesystem::path& file, const std::string& text) {
  RecipeRead result;
  const std::vector<Key> keys = recipe_keys(result.recipe);
  KeysRead read = read_keys(file, text, keys);
  result.recipe.scan.initial.given = read.tables.contains("scan.initial");
  result.recipe.toolpath.from_contour.given = read.tables.contains("toolpath.from_contour");
  result.problems = std::move(read.problems);
  if (result.problems.empty()) check_together(file, result.recipe, result.problems);
  return result;
}

Recipe read_recipe(const std::filesystem::path& file) {
  RecipeRead read = parse_recipe(file, read_text_file(file, "recipe"));
  if (read.problems.empty()) return read.recipe;
  throw Error(Fault::kRecipe, read.problems.front());
}

std::set<std::string> absent_tables(const Recipe& recipe) {
  std::set<std::string> absent = kPresenceTables;
  if (recipe.scan.initial.given) absent.erase("scan.initial");
  if (recipe.toolpath.from_contour.given) absent.erase("toolpath.from_contour");
  return absent;
}

std::string print_recipe(const Recipe& recipe, const std::filesystem::path& folder) {
  Recipe copy = recipe;
  return "# Arris recipe: one part number. Every key stands here with its value; one that keeps its default "
         "may be\n"
         "# left out. * must be given. Lengths are mm, angles degrees, paths relative to this file.\n" +
         print_keys(recipe_keys(copy), folder, absent_tables(recipe));
}

double unit_mm(const std::string& unit) {
  if (unit == "mm") return 1.0;
  if (unit == "cm") return 10.0;
  if (unit == "m") return 1000.0;
  if (unit == "inch") return 25.4;
  throw Error(Fault::kBug, "unit_mm: no unit '" + unit + "'");
}

}  // namespace arris
