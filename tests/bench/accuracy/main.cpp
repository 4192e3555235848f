// Accuracy and time of the whole method on the finite element parts, beside the rigid motions, the paper's
// choices and PCL. Prints Markdown; with --out it replaces the part of that file between its markers.

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "tests/bench/accuracy/case.hpp"
#include "tests/bench/accuracy/table.hpp"
#include "tests/bench/accuracy/times.hpp"
#include "tests/support/bench_program.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_accuracy [--fixtures fixtures/fe] [--seeds 20] [--rounds 15] [--threads 2] [--part NAME] [--out "
    "FILE.md]\n";

struct Arguments {
  std::filesystem::path fixtures, out;
  int seeds = 0, rounds = 0, threads = 0;
  std::string part;
};

Arguments parse(int argc, char** argv) {
  const Words words(argc, argv, kUsage,
                    {"--fixtures", "--out", "--part", "--seeds", "--rounds", "--threads"});
  Arguments arguments;
  arguments.fixtures = words.text("--fixtures", "fixtures/fe");
  arguments.out = words.text("--out");
  arguments.part = words.text("--part");
  arguments.seeds = words.count("--seeds", 20, 1);
  arguments.rounds = words.count("--rounds", 15, 0);
  arguments.threads = words.count("--threads", 2, 0);
  return arguments;
}

CaseResult run_case(const BenchPart& part, const BenchCase& bench_case, int seeds) {
  CaseResult result{part.fe.name(), bench_case.name, part.truth.is_circle(), {}};
  for (int seed = 1; seed <= seeds; ++seed)
    result.seeds.push_back(measure(part, bench_case, static_cast<std::uint64_t>(seed)));
  return result;
}

std::string document(const std::vector<CaseResult>& results, const std::vector<PartTimes>& times,
                     const Arguments& arguments) {
  std::string text =
      "### Goals\n\n" + target_table(results) + "\n### Against what a scan can show\n\n" +
      limit_table(results) + "\n### Times\n\n" + times_table(times, arguments.rounds, arguments.threads) +
      "\n### The whole method\n\n" + overview_table(results) + "\n### The rigid ICPs\n\n" +
      "Mean / max error in mm, mean of the seeds.\n\n" + rigid_table(results) + "\n### Every method\n\n";
  for (const CaseResult& result : results) text += case_table(result) + "\n";
  return text;
}

void run(const Arguments& arguments) {
  std::vector<CaseResult> results;
  std::vector<PartTimes> times;
  for (const std::string name : {"porthole", "nosecone", "sheet", "bracket", "duct"}) {
    if (!arguments.part.empty() && arguments.part != name) continue;
    const BenchPart part(arguments.fixtures / name, arguments.threads);
    for (const BenchCase& bench_case : bench_cases()) {
      std::cerr << name << ": " << bench_case.name << std::endl;
      results.push_back(run_case(part, bench_case, arguments.seeds));
    }
    if (arguments.rounds > 0) times.push_back(measure_times(part, arguments.rounds));
  }
  const std::string text = document(results, times, arguments);
  std::cout << text;
  if (!arguments.out.empty()) put_between_markers(arguments.out, text);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program([&] { run(parse(argc, argv)); }, std::cerr);
}
