#include "cli/batch_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

namespace arris {
namespace {

struct Outcome {
  int exit_code;
  const char* word;
};

/// Worst first. What is not among them (2, 130 of a child that was stopped from outside) never reaches a row.
constexpr std::array<Outcome, 7> kOutcomes{{{1, "crashed"},
                                            {6, "device failed"},
                                            {3, "wrong input"},
                                            {5, "refused"},
                                            {4, "out of tolerance"},
                                            {7, "indeterminate"},
                                            {0, "good"}}};

/// The last line that a child said, without the program's name.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of("\r\n ") + 1);
  const std::size_t end = text.find_last_of('\n');
  std::string line = end == std::string::npos ? text : text.substr(end + 1);
  if (line.starts_with("arris: ")) line.erase(0, 7);
  return line;
}

std::string signal_words(int signal, double late_s) {
  if (late_s > 0.0)
    return "stopped, for it ran longer than " + std::to_string(std::lround(late_s)) + " s (--timeout)";
  std::string words = "ended by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
  if (signal == 9) words += ": stopped from outside, or the machine ran out of memory";
  return words;
}

const InputFile* find_role(const std::vector<InputFile>& inputs, const std::string& role) {
  const auto found =
      std::find_if(inputs.begin(), inputs.end(), [&](const InputFile& input) { return input.role == role; });
  return found == inputs.end() ? nullptr : &*found;
}

bool same(const InputFile& a, const InputFile& b) {
  return a.sha256 == b.sha256 && a.name == b.name;
}

}  // namespace

std::string difference(const RunResult& result, const std::vector<InputFile>& inputs,
                       const std::string& version) {
  if (result.version != version) return "it was made by " + result.version;
  for (const InputFile& now : inputs) {
    const InputFile* then = find_role(result.inputs, now.role);
    if (then == nullptr) return "it was made without the " + now.role;
    if (!same(*then, now)) return "the " + now.role + " changed";
  }
  for (const InputFile& then : result.inputs)
    if (find_role(inputs, then.role) == nullptr) return "it was made with a " + then.role;
  return "";
}

BatchRow row_of(const BatchScan& scan, RunResult result) {
  BatchRow row;
  row.scan = scan;
  row.exit_code = result.exit_code;
  if (!result.refusals.empty())
    row.message = result.refusals.front();
  else if (result.exit_code != 0)
    row.message = result.inspection_text;
  row.result = std::move(result);
  return row;
}

BatchRow row_of_failure(const BatchScan& scan, const ChildEnd& end) {
  BatchRow row;
  row.scan = scan;
  row.exit_code = 1;
  row.message = last_line(end.said);
  row.wall_s = end.wall_s;
  const bool known = end.exit_code == 1 || end.exit_code == 3 || end.exit_code == 6;
  if (end.signal != 0)
    row.message = signal_words(end.signal, end.late_s);
  else if (known)
    row.exit_code = end.exit_code;
  else
    row.message = "ended with exit code " + std::to_string(end.exit_code) + " and without results" +
                  (row.message.empty() ? "" : ": " + row.message);
  return row;
}

int severity_rank(int exit_code) {
  for (std::size_t rank = 0; rank < kOutcomes.size(); ++rank)
    if (kOutcomes[rank].exit_code == exit_code) return static_cast<int>(rank);
  return 0;
}

int worst_exit_code(std::span<const BatchRow> rows) {
  int worst = 0;
  for (const BatchRow& row : rows)
    if (severity_rank(row.exit_code) < severity_rank(worst)) worst = row.exit_code;
  return worst;
}

std::string outcome_word(int exit_code) {
  return kOutcomes[static_cast<std::size_t>(severity_rank(exit_code))].word;
}

std::vector<std::pair<int, std::size_t>> outcome_counts(std::span<const BatchRow> rows) {
  std::map<int, std::size_t> by_rank;
  for (const BatchRow& row : rows) ++by_rank[severity_rank(row.exit_code)];
  std::vector<std::pair<int, std::size_t>> counts;
  for (const auto& [rank, count] : by_rank)
    counts.emplace_back(kOutcomes[static_cast<std::size_t>(rank)].exit_code, count);
  return counts;
}

}  // namespace arris
