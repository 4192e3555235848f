// What big scans cost: rigid fit, deviations and the whole way from file to map, beside PCL and CloudCompare
// in the same run. Prints Markdown; with --out it replaces the part of that file between its markers.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "acquisition/types/error.hpp"
#include "fixtures/synthetic/big_panel.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/bench/scale/rows.hpp"
#include "tests/support/bench_program.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_scale --arris PROGRAM [--rounds 3] [--threads 2] [--edge-tenths 44] [--out FILE.md]\n";

/// A folder for large files, gone at the end.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "arris-scale-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw arris::Error(arris::Fault::kInput, "no folder " + name);
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The start pose is 2 degrees and 10 mm off.
void write_recipe(const std::filesystem::path& folder) {
  std::ofstream(folder / "recipe.toml")
      << "schema = 1\n[part]\nnumber = \"panel\"\ncad = \"panel.stl\"\ncad_units = \"mm\"\n[scan]\nunits = "
         "\"mm\"\n[scan.initial]\nscan_from_cad = [6.0, 5.0, -6.2, 0.99984770, 0.01047, -0.01047, 0.00907]\n"
         "[contour]\naccept = [2]\n[toolpath]\nfile = \"none.csv\"\n[tolerance]\nsurface_profile_mm = "
         "0.4\ncontour_profile_mm = 0.3\nmax_correction_mm = 20.0\n";
}

void run(const Words& words) {
  const Scratch scratch;
  ScaleData data;
  data.folder = scratch.path();
  data.arris = words.text("--arris", "arris");
  data.rounds = words.count("--rounds", 3, 1);
  data.threads = words.count("--threads", 2, 1);
  data.cad = arris::synthetic::big_panel(0.1 * words.count("--edge-tenths", 44, 10));
  arris::synthetic::write_mesh(data.folder / "panel.stl", data.cad, "big panel, mm");
  write_recipe(data.folder);
  std::string text = "Drawing of " + std::to_string(data.cad.triangles.size()) +
                     " triangles; noise 0.05 mm; " + std::to_string(data.threads) + " threads; medians of " +
                     std::to_string(data.rounds) + " rounds, interleaved with the peers.\n\n";
  text += rigid_rows(data) + "\n" + deviation_rows(data) + "\n" + map_rows(data);
  std::cout << text;
  if (words.has("--out")) put_between_markers(words.text("--out"), text);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program(
      [&] {
        run(Words(argc, argv, kUsage, {"--arris", "--rounds", "--threads", "--edge-tenths", "--out"}));
      },
      std::cerr);
}
