#include "tests/bench/scale/peers.hpp"

#include <cstdlib>
#include <regex>

#include "acquisition/types/error.hpp"

namespace arris::bench {

std::optional<CloudCompareRun> cloudcompare_distances(const std::filesystem::path& scan,
                                                      const std::filesystem::path& cad) {
  ::setenv("QT_QPA_PLATFORM", "offscreen", 1);
  CloudCompareRun run;
  run.child = run_child({"CloudCompare", "-SILENT", "-AUTO_SAVE", "OFF", "-C_EXPORT_FMT", "PLY", "-O",
                         scan.string(), "-O", cad.string(), "-C2M_DIST", "-SAVE_CLOUDS", "FILE",
                         scan.string() + ".cloudcompare.ply"});
  if (run.child.code == 127) return std::nullopt;
  if (run.child.code != 0)
    throw Error(Fault::kInput, "CloudCompare failed: " + run.child.out.substr(0, 2000));
  static const std::regex kTime(R"(\[ComputeDistances\] Time: ([0-9.]+) s)");
  std::smatch found;
  if (std::regex_search(run.child.out, found, kTime)) run.distances_s = std::stod(found[1]);
  return run;
}

}  // namespace arris::bench
