#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/files/sha256.hpp"
#include "acquisition/types/error.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "cli/drawing.hpp"
#include "cli/edge_file.hpp"
#include "cli/in_scan.hpp"
#include "cli/json_output.hpp"
#include "cli/measurement.hpp"
#include "cli/recipe_options.hpp"
#include "cli/register_scan.hpp"
#include "cli/report_time.hpp"
#include "registration/edge_calibration.hpp"
#include "report/number_text.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr int kRefused = 5;  // exit code

void check_names(const CalibrateEdgeArgs& args) {
  for (const auto& [option, name] : {std::pair("--scanner", &args.scanner), {"--serial", &args.serial}})
    if (const std::string why = why_no_name(*name); !why.empty())
      throw Error(Fault::kUsage, ErrorText{std::string(option) + " is no name",
                                           {},
                                           why,
                                           "at most 100 characters of printable ASCII",
                                           "arris calibrate edge --help"});
  if (args.scanner.empty())
    throw Error(Fault::kUsage,
                ErrorText{"--scanner is empty", {}, "\"\"", "a name", "arris calibrate edge --help"});
}

/// Before anything is computed: what is there already is replaced only if it is a former calibration, and
/// asked for.
void check_replaceable(const CalibrateEdgeArgs& args) {
  if (!fs::exists(fs::symlink_status(args.out))) return;
  std::string why = "a former calibration";
  try {
    const EdgeFileRead read = parse_edge_file(args.out, read_edge_text(args.out));
    if (read.problems.empty() && args.force) return;
    if (!read.problems.empty()) why = "no edge calibration: " + read.problems.front().what;
  } catch (const Error& error) {
    why = error.text().what;
  }
  throw Error(Fault::kInput, {"--out exists already", args.out.string(), why,
                              args.force ? "a new name, or a former calibration" : "a new name",
                              "choose another name, or --force if it is a calibration that may go"});
}

/// The reference's recipe as it is used here: nothing is followed, and the scanner not known yet.
Recipe reference_recipe(const fs::path& file) {
  Recipe recipe = read_recipe(file);
  if (recipe.contour.role != "edge")
    throw Error(Fault::kRecipe, {"a contour that is still to be cut calibrates nothing", file.string(),
                                 "contour.role = \"" + recipe.contour.role + "\"", "\"edge\"",
                                 "take the recipe of the reference"});
  recipe.registration.method = "rigid";
  recipe.scan.edge_calibration.clear();
  return recipe;
}

/// What the scans gave, one entry a scan.
struct Scans {
  std::vector<Registration> registered;
  std::vector<double> spacing_mm;
  std::vector<std::string> sha256;
  std::string date;    ///< of the youngest
  std::string reason;  ///< the first that could not be registered
};

/// One scan given twice would look like two that agree.
void add_hash(const fs::path& file, std::vector<std::string>& hashes) {
  std::string hash = sha256_file(file);
  if (std::find(hashes.begin(), hashes.end(), hash) != hashes.end())
    throw Error(Fault::kInput, {"a scan is given twice", file.string(), "the same bytes as an earlier one",
                                "scans of their own", "leave it out, or scan the reference again"});
  hashes.push_back(std::move(hash));
}

Scans register_scans(const CalibrateEdgeArgs& args, const Recipe& recipe, const CadModel& cad) {
  Scans scans;
  console::Progress progress;
  RegistrationOptions options = registration_options(recipe, args.threads);
  options.edge.scanner = {0.0, 0.0};
  for (const fs::path& file : args.scans) {
    progress.stage(static_cast<int>(scans.sha256.size()) + 1, static_cast<int>(args.scans.size()),
                   "aligning " + file.filename().string());
    add_hash(file, scans.sha256);
    Measurement measurement = in_scan(
        file, [&] { return read_measurement(recipe, file, std::nullopt, std::nullopt, args.threads); });
    Registration found = in_scan(file, [&] { return register_scan(recipe, cad, measurement, options); });
    if (scans.reason.empty() && !found.refusals.empty())
      scans.reason = file.string() + ": " + found.refusals.front();
    scans.registered.push_back(std::move(found));
    scans.spacing_mm.push_back(measurement.prepared.model.spacing_mm);
    scans.date = std::max(scans.date, report_time(file).substr(0, 10));
  }
  return scans;
}

EdgeCalibration calibration_of(const CalibrateEdgeArgs& args, const CadModel& cad, const Scans& scans) {
  EdgeCalibrationOptions options;
  options.size_sd_mm = args.size_sd_mm;
  if (scans.reason.empty()) return calibrate_edge(cad, scans.registered, options);
  EdgeCalibration refused;
  refused.reason = scans.reason;
  return refused;
}

EdgeFile file_of(const CalibrateEdgeArgs& args, const Recipe& recipe, const Scans& scans,
                 const EdgeCalibration& found) {
  EdgeFile file;
  file.scanner = args.scanner;
  file.serial = args.serial;
  file.edge = {report::rounded(found.edge.out_mm), report::rounded(found.edge.sd_mm)};
  file.spacing_mm = report::rounded(std::accumulate(scans.spacing_mm.begin(), scans.spacing_mm.end(), 0.0) /
                                    static_cast<double>(scans.spacing_mm.size()));
  file.date = scans.date;
  file.recipe_sha256 = sha256_file(args.recipe);
  file.cad_sha256 = sha256_file(recipe.part.cad);
  file.scan_sha256 = scans.sha256;
  return file;
}

void print_contours(const CalibrateEdgeArgs& args, const EdgeCalibration& found) {
  if (!found.contours.empty())
    console::print(fmt::format("{:>8}  {:>6}  {:>9}  {:>8}  {:>10}  {}", "contour", "seen", "stretches",
                               "out mm", "scatter mm", "scan"));
  for (const CalibratedContour& one : found.contours) {
    const std::string scan = args.scans[one.scan].filename().string();
    console::print(
        one.used ? fmt::format("{:>8}  {:>4.0f} %  {:>9}  {:>+8.3f}  {:>10.3f}  {}", one.id,
                               100.0 * one.seen_ratio, one.stretches, one.out_mm, one.scatter_mm, scan)
                 : fmt::format(
                       "{:>8}  {:>4.0f} %  {:>9}  {:>8}  {:>10}  {}, not used: open, or not seen all round",
                       one.id, 100.0 * one.seen_ratio, "-", "-", "-", scan));
  }
}

void print_found(const CalibrateEdgeArgs& args, const EdgeCalibration& found) {
  print_contours(args, found);
  if (!found.usable())
    console::print("edge offset   REFUSED\n              " + found.reason);
  else
    console::print(
        fmt::format("edge offset   {:+.3f} mm, standard deviation {:.3f} mm, over {} stretches: {}",
                    found.edge.out_mm, found.edge.sd_mm, found.stretches,
                    found.edge.out_mm < 0.0 ? "edges are shown inside the material"
                                            : "edges are shown too far out, in the void"));
}

}  // namespace

int run_calibrate_edge(const CalibrateEdgeArgs& args) {
  check_names(args);
  check_replaceable(args);
  const Recipe recipe = reference_recipe(args.recipe);
  const Drawing drawing = read_drawing(recipe, false, args.threads);
  const CadModel cad = prepare_cad(drawing.mesh, drawing.accepted, drawing.others, args.threads);
  const Scans scans = register_scans(args, recipe, cad);
  const EdgeCalibration found = calibration_of(args, cad, scans);
  const EdgeFile file = file_of(args, recipe, scans, found);
  if (args.json)
    console::print(edge_calibration_json(args.out.string(), file, found));
  else
    print_found(args, found);
  if (!found.usable()) return kRefused;
  AtomicFile written(args.out);
  written.stream() << print_edge_file(file);
  if (!args.json)
    console::print("wrote         " + args.out.string() + "; next: [scan] edge_calibration = " +
                   quote(args.out.string()) + " in the recipes of the parts");
  console::flush();  // a result that nobody can have is an error, and an error leaves no file
  written.commit();
  return 0;
}

}  // namespace arris
