// How far a corrected path can be trusted: synthetic parts drawn by seed, scanned whole and with what shops
// have (gaps, strays, burrs); the errors, and whether the stated uncertainty covers them. Prints Markdown;
// with --out it replaces the part of that file between its markers.

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"
#include "tests/bench/trust/report.hpp"
#include "tests/support/bench_program.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_trust [--fixtures fixtures/fe] [--first 1000] [--seeds 200] [--threads 2]\n"
    "            [--only complete|independent|ten|twenty|strays|burrs] [--out FILE.md]\n"
    "--only takes a quick look: the page is left as it is.\n";

struct Arguments {
  std::filesystem::path fixtures, out;
  std::vector<StudyCase> cases;
  int first = 0, seeds = 0, threads = 0;
};

/// All cases, or the one that is asked for.
std::vector<StudyCase> cases_of(const std::string& only) {
  std::vector<StudyCase> cases;
  for (const StudyCase study_case : kStudyCases)
    if (only.empty() || only == words_of(study_case).word) cases.push_back(study_case);
  if (cases.empty()) throw arris::Error(arris::Fault::kUsage, "no case " + only + "\n" + kUsage);
  return cases;
}

Arguments parse(int argc, char** argv) {
  const Words words(argc, argv, kUsage, {"--fixtures", "--first", "--seeds", "--threads", "--only", "--out"});
  Arguments arguments;
  arguments.fixtures = words.text("--fixtures", "fixtures/fe");
  arguments.cases = cases_of(words.text("--only"));
  if (!words.has("--only")) arguments.out = words.text("--out");
  arguments.first = words.count("--first", 1000, 0);
  arguments.seeds = words.count("--seeds", 200, 1);
  arguments.threads = words.count("--threads", 2, 1);
  return arguments;
}

/// Progress: rms / max of each case, in mm.
std::string line(std::uint64_t seed, const std::string& kind, const std::vector<StudyResult>& results,
                 std::size_t i) {
  std::string text = fmt::format("seed {} {}:", seed, kind);
  for (const StudyResult& result : results)
    text += fmt::format(" {:.3f}/{:.3f}{}", result.seeds[i].rms_mm, result.seeds[i].max_mm,
                        result.seeds[i].refusals.empty() ? "" : "(refused)");
  return text + "\n";
}

/// A seed's scans run on one thread, several seeds beside each other.
std::vector<StudyResult> measure(const Arguments& arguments) {
  const auto count = static_cast<std::size_t>(arguments.seeds);
  std::vector<StudyResult> results;
  for (const StudyCase study_case : arguments.cases)
    results.push_back({study_case, std::vector<StudyOutcome>(count)});
  arris::parallel_for(count, 1, arguments.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t seed = static_cast<std::uint64_t>(arguments.first) + i;
      const StudyPart study = study_part(seed, arguments.fixtures);
      for (StudyResult& result : results) result.seeds[i] = study_scan(study, result.study_case, seed, 1);
      std::cerr << line(seed, study.kind, results, i);
    }
  });
  return results;
}

void run(const Arguments& arguments) {
  const std::vector<StudyResult> results = measure(arguments);
  const std::string text = "### Figures\n\n" + figure_table(results) +
                           "\n### Distribution over the seeds\n\n" + distribution_table(results) +
                           "\n### Coverage of the stated 95 % bound\n\n" + study_coverage_table(results) +
                           "\n### Refused\n\n" + refusal_list(results);
  std::cout << text;
  if (!arguments.out.empty()) put_between_markers(arguments.out, text);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program([&] { run(parse(argc, argv)); }, std::cerr);
}
