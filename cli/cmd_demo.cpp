#include <cstdlib>
#include <fstream>

#include "acquisition/files/atomic_file.hpp"
#include "acquisition/types/error.hpp"
#include "cli/commands.hpp"
#include "cli/console.hpp"
#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/scan.hpp"
#include "fixtures/synthetic/write.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 1;
constexpr const char* kMark = "about-this-demo.txt";
constexpr const char* kAbout =
    "This folder was made by `arris demo`; the next one replaces it.\n\n"
    "A thin composite part was solved by finite elements: how it lies on its fixture, clamped and bent.\n"
    "scan.ply was sampled from that, with noise, walls, strays and a gap, turned on its fixture.\n\n"
    "recipe.toml    every choice for this part number; names the files below\n"
    "cad.stl        the drawing        contour.csv  its opening        path.csv  the tool path on the "
    "drawing\n"
    "cell.toml      the station: frames, tool, robot\n"
    "scan.ply       the part as it lies\n"
    "result/        what the main job made of it; begin with result/report.html\n\n"
    "To run it yourself:  arris run recipe.toml --scan scan.ply --out mine\n";

/// The folder of the built-in parts: ARRIS_FIXTURES, or fixtures/ above the program, or of the checkout it
/// was built from.
fs::path fixtures_folder() {
  if (const char* given = std::getenv("ARRIS_FIXTURES"); given != nullptr && *given != '\0') {
    if (fs::is_directory(fs::path(given) / "fe")) return given;
    throw Error(
        Fault::kInput,
        ErrorText{
            "ARRIS_FIXTURES names no folder of built-in parts", given, {}, "a folder that holds fe/", {}});
  }
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); !folder.empty();
       folder = folder.parent_path()) {
    if (fs::is_directory(folder / "fixtures" / "fe")) return folder / "fixtures";
    if (folder == folder.parent_path()) break;
  }
  if (fs::is_directory(fs::path(ARRIS_BUILT_FROM) / "fixtures" / "fe"))
    return fs::path(ARRIS_BUILT_FROM) / "fixtures";
  throw Error(Fault::kInput,
              ErrorText{"the built-in parts are not here", "fixtures/fe, looked for above the program",
                        "no such folder", "the checkout that the program was built from",
                        "set ARRIS_FIXTURES to the fixtures folder of the checkout"});
}

/// A scan as a shop would get it: noise, walls of the cut, strays, a gap, uneven density, turned on its
/// fixture.
synthetic::SyntheticScan demo_scan(const synthetic::FePart& part) {
  synthetic::ScanOptions options;
  options.points = 60000;
  options.missing_ratio = 0.05;
  options.stray_ratio = 0.003;
  options.wall_ratio = 0.02;
  options.density_variation_ratio = 2.0;
  options.scan_from_cad = RigidMotion(Eigen::Translation3d(-85.0, 40.0, 120.0) *
                                      Eigen::AngleAxisd(0.6, Eigen::Vector3d(0.2, -0.3, 1.0).normalized()));
  return synthetic::sample_scan(part, options, kSeed);
}

/// Recipe, drawing, path, cell and a fresh scan in the demo's own folder.
void make_inputs(const fs::path& fixture, const fs::path& out) {
  AtomicFolder folder(out, true, kMark);
  std::ofstream(folder.path() / kMark) << kAbout;
  for (const char* name : {"recipe.toml", "cad.stl", "contour.csv", "path.csv", "cell.toml"})
    fs::copy_file(fixture / name, folder.path() / name);
  synthetic::write_ply(folder.path() / "scan.ply", demo_scan(synthetic::load_fe_part(fixture)));
  folder.commit();
}

}  // namespace

int run_demo(const DemoArgs& args) {
  make_inputs(fixtures_folder() / "fe" / args.part, args.out);
  RunArgs run;
  run.recipe = args.out / "recipe.toml";
  run.scan = args.out / "scan.ply";
  run.out = args.out / "result";
  run.force = true;
  run.json = args.json;
  run.threads = args.threads;
  const int code = run_main_job(run);
  const fs::path result = fs::absolute(*run.out);
  if (args.json || !fs::exists(result)) return code;
  console::print("");
  console::print("This was the main job on a built-in part that finite elements bent on its fixture.");
  console::print("Look at the report:    " + (result / "report.html").string());
  console::print(
      "  the verdict at its top, then the error along the contour before and after the correction");
  console::print("The corrected path:    " + (result / "corrected.csv").string());
  console::print("All that went in:      " + fs::absolute(args.out).string());
  return code;
}

}  // namespace arris
