// Accuracy and time of the whole method on the finite element parts, beside the rigid motions, the paper's
// choices and PCL. Prints Markdown; with --out it replaces the part of that file between its markers.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "acquisition/types/error.hpp"
#include "tests/bench/accuracy/case.hpp"
#include "tests/bench/accuracy/table.hpp"
#include "tests/bench/accuracy/times.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_accuracy [--fixtures fixtures/fe] [--seeds 20] [--rounds 15] [--threads 2] [--part NAME] [--out "
    "FILE.md]\n";
const std::string kBegin = "<!-- begin: written by ./run bench -->\n";
const std::string kEnd = "<!-- end: written by ./run bench -->\n";

struct Arguments {
  std::filesystem::path fixtures = "fixtures/fe", out;
  int seeds = 20, rounds = 15, threads = 2;
  std::string part;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) throw arris::Error(arris::Fault::kUsage, name + " needs a value\n" + kUsage);
    const std::string value = argv[i + 1];
    if (name == "--fixtures")
      arguments.fixtures = value;
    else if (name == "--out")
      arguments.out = value;
    else if (name == "--part")
      arguments.part = value;
    else if (name == "--seeds")
      arguments.seeds = std::max(1, std::atoi(value.c_str()));
    else if (name == "--rounds")
      arguments.rounds = std::max(0, std::atoi(value.c_str()));
    else if (name == "--threads")
      arguments.threads = std::atoi(value.c_str());
    else
      throw arris::Error(arris::Fault::kUsage, "no option " + name + "\n" + kUsage);
  }
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
  std::string text = "### Goals\n\n" + target_table(results) + "\n### Times\n\n" +
                     times_table(times, arguments.rounds, arguments.threads) + "\n### The whole method\n\n" +
                     overview_table(results) + "\n### The rigid ICPs\n\n" +
                     "Mean / max error in mm, mean of the seeds.\n\n" + rigid_table(results) +
                     "\n### Every method\n\n";
  for (const CaseResult& result : results) text += case_table(result) + "\n";
  return text;
}

void put_between_markers(const std::filesystem::path& file, const std::string& text) {
  std::ifstream in(file, std::ios::binary);
  const std::string old{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::size_t begin = old.find(kBegin), end = old.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw arris::Error(arris::Fault::kInput, file.string() + " has no section to replace: the lines " +
                                                 kBegin + "and " + kEnd + "are needed");
  const std::size_t after_begin = begin + kBegin.size();
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << old.substr(0, after_begin) << "\n" << text << old.substr(end);
  out.close();
  if (!out) throw arris::Error(arris::Fault::kInput, "cannot write " + file.string());
}

void run(const Arguments& arguments) {
  std::vector<CaseResult> results;
  std::vector<PartTimes> times;
  for (const std::string name : {"porthole", "nosecone", "sheet"}) {
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
  try {
    run(parse(argc, argv));
    return 0;
  } catch (const arris::Error& error) {
    std::cerr << error.what() << "\n";
    return arris::exit_code(error.fault());
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
