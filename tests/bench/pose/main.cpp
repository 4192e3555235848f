// Poses from nothing: each part of the fixtures and some plates, in a random pose, with things around it.
// Prints Markdown; with --out it replaces the part of that file between its markers.

#include <iostream>

#include "tests/bench/pose/pose_table.hpp"
#include "tests/support/bench_program.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_pose [--fixtures fixtures/fe] [--poses 1000] [--first 0] [--threads 2] [--part NAME] "
    "[--scene NUMBER] [--out FILE.md] [--each]\n";

struct Arguments {
  std::filesystem::path fixtures, out;
  std::string part;
  int poses = 0, first = 0, threads = 0;
  int scene = -1;     ///< of pose_scenes(); -1: all
  bool each = false;  ///< a line a pose that is not right, on stderr
};

Arguments parse(int argc, char** argv) {
  const Words words(argc, argv, kUsage,
                    {"--first", "--fixtures", "--out", "--part", "--poses", "--scene", "--threads"},
                    {"--each"});
  Arguments arguments;
  arguments.fixtures = words.text("--fixtures", "fixtures/fe");
  arguments.out = words.text("--out");
  arguments.part = words.text("--part");
  arguments.poses = words.count("--poses", 1000, 1);
  arguments.first = words.count("--first", 0, 0);
  arguments.scene = words.count("--scene", -1, -1);
  arguments.threads = words.count("--threads", 2, 0);
  arguments.each = words.has("--each");
  return arguments;
}

/// Pose number n is of part n % parts, in scene (n / parts) % scenes, with seed n: adding poses changes none.
std::vector<PoseRow> run_all(const Arguments& arguments) {
  const std::vector<PosePart> parts = pose_parts(arguments.fixtures);
  const std::vector<PoseScene> scenes = pose_scenes();
  std::vector<PoseRow> rows;
  for (int n = arguments.first; n < arguments.first + arguments.poses; ++n) {
    const PosePart& part = parts[static_cast<std::size_t>(n) % parts.size()];
    const std::size_t s = static_cast<std::size_t>(n) / parts.size() % scenes.size();
    const PoseScene& scene = scenes[s];
    if (!arguments.part.empty() && arguments.part != part.name) continue;
    if (arguments.scene >= 0 && arguments.scene != static_cast<int>(s)) continue;
    rows.push_back(
        {part.name, scene.name, try_pose(part, scene, static_cast<std::uint64_t>(n) + 1, arguments.threads)});
    if (arguments.each) std::cerr << line_of(n, rows.back()) << std::endl;
  }
  return rows;
}

void run(const Arguments& arguments) {
  const std::string text = "Poses " + std::to_string(arguments.first) + " to " +
                           std::to_string(arguments.first + arguments.poses - 1) + ", each a seed.\n\n" +
                           pose_tables(run_all(arguments));
  std::cout << text;
  if (!arguments.out.empty() && arguments.part.empty()) put_between_markers(arguments.out, text);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program([&] { run(parse(argc, argv)); }, std::cerr);
}
