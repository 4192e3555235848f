#include "tests/bench/pose/pose_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace arris::bench {
namespace {

struct Tally {
  int poses = 0, right = 0, refused = 0, wrong = 0, equal = 0, by_surface = 0;
  std::vector<double> search_ms, over_best_mm;

  void add(const PoseTrial& trial) {
    ++poses;
    right += trial.verdict == PoseVerdict::kRight;
    refused += trial.verdict == PoseVerdict::kRefused;
    wrong += trial.verdict == PoseVerdict::kWrong;
    equal += trial.verdict == PoseVerdict::kRight && trial.equal_poses > 1;
    by_surface += trial.verdict == PoseVerdict::kRight && trial.start != "matching loops";
    search_ms.push_back(trial.search_ms);
    if (trial.verdict != PoseVerdict::kRefused) over_best_mm.push_back(trial.off_mm - trial.best_off_mm);
  }
};

double quantile(std::vector<double> values, double ratio) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(ratio * static_cast<double>(values.size() - 1))];
}

std::string table_line(const std::string& name, const Tally& t) {
  return fmt::format("| {} | {} | {} | {:.1f} % | {} | {} | {} | {} | {:.2f} / {:.2f} | {:.0f} / {:.0f} |\n",
                     name, t.poses, t.right, 100.0 * t.right / t.poses, t.refused, t.wrong, t.equal,
                     t.by_surface, quantile(t.over_best_mm, 0.5), quantile(t.over_best_mm, 1.0),
                     quantile(t.search_ms, 0.5), quantile(t.search_ms, 1.0));
}

template <typename Name>
std::string table_by(const std::vector<PoseRow>& rows, const char* title, Name&& name_of) {
  std::vector<std::string> order;
  std::map<std::string, Tally> tallies;
  Tally all;
  for (const PoseRow& row : rows) {
    const std::string& name = name_of(row);
    if (!tallies.contains(name)) order.push_back(name);
    tallies[name].add(row.trial);
    all.add(row.trial);
  }
  std::string text = fmt::format(
      "| {} | poses | right | | refused | wrong and accepted | of the right: equal poses reported | found by "
      "pieces or surface | beyond the best rigid motion, median / most, mm | search, median / most, ms |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n",
      title);
  for (const std::string& name : order) text += table_line(name, tallies[name]);
  return text + table_line("**all**", all);
}

/// What a refusal says before its numbers.
std::string kind_of(const std::string& reason) {
  return reason.substr(0, reason.find_first_of(":("));
}

}  // namespace

std::string pose_tables(const std::vector<PoseRow>& rows) {
  std::map<std::string, int> reasons;
  for (const PoseRow& row : rows)
    if (row.trial.verdict == PoseVerdict::kRefused) ++reasons[kind_of(row.trial.reason)];
  std::string text = table_by(rows, "part", [](const PoseRow& row) { return row.part; }) + "\n" +
                     table_by(rows, "scene", [](const PoseRow& row) { return row.scene; });
  if (!reasons.empty()) text += "\n| refused, saying | poses |\n|---|---|\n";
  for (const auto& [reason, count] : reasons) text += fmt::format("| {} | {} |\n", reason, count);
  return text;
}

std::string line_of(int number, const PoseRow& row) {
  static const char* const kVerdicts[] = {"right", "REFUSED", "WRONG"};
  return fmt::format(
      "{:4} {:7} {:24} {:34} off {:6.2f} best {:6.2f} score {:5.2f} runner-up {:5.2f} ms {:5.1f} equal {} {} "
      "{}",
      number, kVerdicts[static_cast<int>(row.trial.verdict)], row.part, row.scene, row.trial.off_mm,
      row.trial.best_off_mm, row.trial.score_mm, row.trial.runner_up_ratio, row.trial.search_ms,
      row.trial.equal_poses, row.trial.start, row.trial.reason);
}

}  // namespace arris::bench
