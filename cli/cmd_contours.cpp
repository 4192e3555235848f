#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/files/file_info.hpp"
#include "acquisition/files/sha256.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/contours_file.hpp"
#include "cli/contours_outputs.hpp"
#include "cli/file_contours.hpp"
#include "cli/interrupt.hpp"
#include "cli/json_output.hpp"
#include "cli/recipe.hpp"
#include "report/picture.hpp"

namespace arris {
namespace {

constexpr std::size_t kDroppedShown = 10;
constexpr double kStraightMm = 1e8;  // a bend radius beyond this is a straight line

/// The recipe's drawing, or a scan of its part; without a recipe a mesh counts as a drawing.
FileRole role_of(const ContoursArgs& args, const Recipe& recipe) {
  if (!args.recipe) return FileRole::kDrawing;
  std::error_code error;
  return std::filesystem::equivalent(args.file, recipe.part.cad, error) ? FileRole::kDrawing
                                                                        : FileRole::kScan;
}

std::string row_text(const FoundContour& found, const std::string& choice) {
  const double radius_mm = found.min_bend_radius_mm;
  return fmt::format("{:>3}  {:>11.1f}  {:<6}  {:>9}  {:<8}{}", found.contour.id, found.length_mm,
                     found.contour.closed ? "closed" : "open",
                     radius_mm > 0.0 && radius_mm < kStraightMm ? fmt::format("{:.1f}", radius_mm) : "-",
                     choice, found.note);
}

void print_table(const ContoursArgs& args, const FileContours& file, const ContourChoice& choice) {
  console::print(args.file.filename().string() + ": " + std::to_string(file.contours.found.size()) +
                 (file.contours.found.size() == 1 ? " contour" : " contours") + " (" + file.format + ")");
  if (!file.contours.found.empty())
    console::print(
        fmt::format("{:>3}  {:>11}  {:<6}  {:>9}  {:<8}{}", "id", "length mm", "", "bend mm", "", "note"));
  for (std::size_t i = 0; i < file.contours.found.size(); ++i) {
    const std::string word = args.accept.empty() ? "" : choice.contours[i].accepted ? "accept" : "reject";
    console::print(row_text(file.contours.found[i], word));
  }
  for (const std::string& note : file.contours.notes) console::print("note: " + note);
  if (!file.contours.dropped.empty())
    console::print(std::to_string(file.contours.dropped.size()) + " more dropped:");
  for (std::size_t i = 0; i < std::min(kDroppedShown, file.contours.dropped.size()); ++i) {
    const FoundContour& found = file.contours.dropped[i];
    console::print(fmt::format("     {:>11.1f}  {:<6}  {}", found.length_mm,
                               found.contour.closed ? "closed" : "open", found.note));
  }
  if (file.contours.dropped.size() > kDroppedShown) console::print("     ... (--json lists all)");
}

/// A file in metres that is read as millimetres shows by its size.
void doubt_units(const FileContours& file) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : file.cloud.points_mm) box.extend(p.cast<double>());
  for (const Eigen::Vector3d& p : file.mesh.vertices_mm) box.extend(p);
  if (!box.isEmpty() && guess_unit(box.sizes().maxCoeff()) == "m")
    console::note("the file was read as mm; by its size it is perhaps in m: --units m");
}

void draw(const ContoursArgs& args, const FileContours& file) {
  report::ContourDrawing drawing;
  drawing.title = "Contours of " + args.file.filename().string();
  drawing.subtitle = file.format;
  for (const FoundContour& found : file.contours.found) drawing.contours.push_back(found.contour);
  for (const FoundContour& found : file.contours.dropped) drawing.dropped.push_back(found.contour);
  if (file.mesh.empty())
    drawing.points_mm = file.cloud.points_mm;
  else
    drawing.mesh = &file.mesh;
  write_file(*args.png, report::contours_picture(drawing));
}

}  // namespace

int run_contours(const ContoursArgs& args) {
  if (args.out && args.accept.empty())
    throw Error(Fault::kUsage,
                ErrorText{"--out needs a choice", {}, {}, "--accept IDS", "arris contours --help"});
  const Recipe recipe = args.recipe ? read_recipe(*args.recipe) : Recipe();
  check_contours_outputs(args, recipe);
  const FileRole role = role_of(args, recipe);
  const std::string& recipe_units = role == FileRole::kDrawing ? recipe.part.cad_units : recipe.scan.units;
  const double to_mm = unit_mm(args.recipe ? recipe_units : args.units.empty() ? "mm" : args.units);
  const FileContours file = find_file_contours(args.file, role, to_mm, recipe, args.threads);
  stop_if_interrupted();
  if (!args.recipe && args.units.empty()) doubt_units(file);
  ContourChoice choice = choose(file.contours, args.accept, file.offset_mm);
  choice.file = args.file.filename().string();
  choice.to_mm = to_mm;
  if (args.out) {
    choice.sha256 = sha256_file(args.file);
    write_file(*args.out, contour_choice_json(choice));
  }
  if (args.png) draw(args, file);
  if (args.json) {
    console::print(contours_json(args.file.string(), file.contours));
    return 0;
  }
  print_table(args, file, choice);
  if (args.png) console::print("wrote " + args.png->string());
  if (args.out)
    console::print("wrote " + args.out->string() + "; next: arris run RECIPE --scan " + args.file.string() +
                   " --contours " + args.out->string());
  return 0;
}

}  // namespace arris
