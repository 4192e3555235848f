#include "tests/bench/scale/peers.hpp"

#include <cstdlib>
#include <regex>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

std::optional<double> printed_s(const std::string& out, const std::string& step) {
  std::smatch found;
  const std::regex time(R"(\[)" + step + R"(\] Time: ([0-9.]+) s)");
  return std::regex_search(out, found, time) ? std::optional(std::stod(found[1])) : std::nullopt;
}

}  // namespace

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
  run.distances_s = printed_s(run.child.out, "ComputeDistances");
  run.first_pass_s = printed_s(run.child.out, "computeApproxDistances");
  return run;
}

}  // namespace arris::bench
