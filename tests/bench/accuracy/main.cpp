// Accuracy and time of the whole method on the finite element parts, beside the rigid motions, the paper's
// choices and PCL. Prints Markdown; with --out it replaces the part of that file between its markers.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"
#include "tests/bench/accuracy/case.hpp"
#include "tests/bench/accuracy/part_goals.hpp"
#include "tests/bench/accuracy/part_pictures.hpp"
#include "tests/bench/accuracy/special.hpp"
#include "tests/bench/accuracy/table.hpp"
#include "tests/bench/accuracy/times.hpp"
#include "tests/support/bench_program.hpp"

namespace {

using namespace arris::bench;  // NOLINT: one small program

const char kUsage[] =
    "bench_accuracy [--fixtures fixtures/fe] [--seeds 20] [--rounds 15] [--threads 2] [--out FILE.md]\n"
    "               [--images FOLDER] [--part NAME] [--only WORD]\n"
    "--part porthole|nosecone|sheet|bracket|duct and --only take a quick look: the page is left as it is.\n"
    "--only: a way to scan the parts (clean, fine, coarse, rows, walls, missing, clutter, hard, dense), or "
    "cut,\n"
    "size, faces, far, times, pictures.\n";
const char kImagesOnPage[] = "images/results";

struct Arguments {
  std::filesystem::path fixtures, out, images;
  int seeds = 0, rounds = 0, threads = 0;
  std::string part, only;
  [[nodiscard]] bool is_whole() const { return part.empty() && only.empty(); }
  [[nodiscard]] bool wants(const std::string& word) const { return only.empty() || only == word; }
};

/// Rows that are no scans of the parts as they are, by the word of --only.
using SpecialRows = std::vector<GoalRow> (*)(const SpecialSetup&);
std::vector<std::pair<std::string, SpecialRows>> special_rows() {
  return {{"cut", cut_rows}, {"size", size_rows},   {"faces", face_rows},
          {"far", far_rows}, {"bound", bound_rows}, {"time", time_rows}};
}

const std::vector<std::string> kParts = {"porthole", "nosecone", "sheet", "bracket", "duct"};

std::vector<std::string> case_words() {
  std::vector<std::string> known = {"times", "pictures"};
  for (const auto& [word, rows] : special_rows()) known.push_back(word);
  for (const BenchCase& one : bench_cases()) known.push_back(one.word);
  return known;
}

/// A misspelt word would measure nothing.
void check(const std::string& what, const std::string& word, const std::vector<std::string>& known) {
  if (!word.empty() && std::find(known.begin(), known.end(), word) == known.end())
    throw arris::Error(arris::Fault::kUsage, "no " + what + " " + word + "\n" + kUsage);
}

Arguments parse(int argc, char** argv) {
  const Words words(
      argc, argv, kUsage,
      {"--fixtures", "--out", "--images", "--part", "--only", "--seeds", "--rounds", "--threads"});
  Arguments arguments;
  arguments.fixtures = words.text("--fixtures", "fixtures/fe");
  arguments.out = words.text("--out");
  arguments.images = words.text("--images");
  arguments.part = words.text("--part");
  arguments.only = words.text("--only");
  check("part", arguments.part, kParts);
  check("case", arguments.only, case_words());
  arguments.seeds = words.count("--seeds", 20, 1);
  arguments.rounds = words.count("--rounds", 15, 0);
  arguments.threads = words.count("--threads", 2, 1);
  return arguments;
}

/// Each scan on one thread, several beside each other. Progress: mean / max of each, in mm.
CaseResult run_case(const BenchPart& part, const BenchCase& bench_case, const Arguments& arguments) {
  const auto count = static_cast<std::size_t>(std::min(arguments.seeds, bench_case.most_seeds));
  CaseResult result{part.fe.name(),          bench_case.name,        bench_case.goal,
                    bench_case.every_method, part.truth.is_circle(), std::vector<Outcome>(count)};
  arris::parallel_for(count, 1, arguments.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result.seeds[i] = measure(part, bench_case, i + 1);
  });
  std::string line = result.part + ", " + result.scan + ":";
  for (const Outcome& outcome : result.seeds)
    line += outcome.error[kWhole]
                ? fmt::format(" {:.3f}/{:.3f}", outcome.error[kWhole]->mean_mm, outcome.error[kWhole]->max_mm)
                : " refused";
  std::cerr << line << std::endl;
  return result;
}

std::string parts_text(const std::vector<CaseResult>& results) {
  std::string text =
      "### The paper's goals\n\n" + target_table(results) + "\n### Coverage of the stated 95 % bound\n\n" +
      part_coverage_table(results) + "\n### The whole method\n\n" + overview_table(results) +
      "\n### Distribution over the seeds\n\n" + distribution_table(results) + "\n### Refused scans\n\n" +
      refusal_list(results) + "\n### The rigid ICPs\n\nMean / max error in mm, mean of the seeds.\n\n" +
      rigid_table(results) + "\n### Every method\n\n";
  for (const CaseResult& result : results)
    if (result.every_method) text += case_table(result) + "\n";
  return text;
}

/// What is measured, part by part.
struct Measured {
  std::vector<CaseResult> results;
  std::vector<PartTimes> times;
  std::vector<Figure> figures;
};

Measured measure_parts(const Arguments& arguments) {
  Measured measured;
  for (const std::string& name : kParts) {
    if (!arguments.part.empty() && arguments.part != name) continue;
    const BenchPart part(arguments.fixtures / name, 1);
    for (const BenchCase& bench_case : bench_cases())
      if (arguments.wants(bench_case.word)) measured.results.push_back(run_case(part, bench_case, arguments));
    if (arguments.wants("pictures"))
      for (Figure& figure : part_pictures(part)) measured.figures.push_back(std::move(figure));
    if (arguments.rounds > 0 && arguments.wants("times"))
      measured.times.push_back(
          measure_times(BenchPart(arguments.fixtures / name, arguments.threads), arguments.rounds));
  }
  return measured;
}

std::vector<GoalRow> measure_special(const Arguments& arguments) {
  std::vector<GoalRow> all;
  if (!arguments.part.empty()) return all;
  for (const auto& [word, rows_of] : special_rows()) {
    if (!arguments.wants(word)) continue;
    std::vector<GoalRow> rows = rows_of({arguments.fixtures, arguments.seeds, arguments.threads});
    std::cerr << goal_table(rows) << std::flush;
    std::move(rows.begin(), rows.end(), std::back_inserter(all));
  }
  return all;
}

std::string document(const Measured& measured, const std::vector<GoalRow>& special,
                     const Arguments& arguments) {
  std::vector<GoalRow> goals = part_goals(measured.results);
  goals.insert(goals.end(), special.begin(), special.end());
  std::string text = "### What it must reach\n\n" + goal_table(goals) + "\n";
  if (const std::string notes = notes_list(goals); !notes.empty())
    text += "Refused scans of the rows that are no scans of the parts as they are:\n\n" + notes + "\n";
  if (!measured.figures.empty())
    text += "### The parts and their errors\n\n" + pictures_text(measured.figures, kImagesOnPage) + "\n";
  if (!measured.times.empty())
    text += "### Times\n\n" + times_table(measured.times, arguments.rounds, arguments.threads) + "\n";
  if (!measured.results.empty()) text += parts_text(measured.results);
  return text;
}

void run(const Arguments& arguments) {
  const Measured measured = measure_parts(arguments);
  const std::string text = document(measured, measure_special(arguments), arguments);
  std::cout << text;
  if (!arguments.images.empty()) write_figures(measured.figures, arguments.images);
  if (!arguments.out.empty() && arguments.is_whole()) put_between_markers(arguments.out, text);
}

}  // namespace

int main(int argc, char** argv) {
  return run_program([&] { run(parse(argc, argv)); }, std::cerr);
}
