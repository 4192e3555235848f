#include "tests/bench/accuracy/goal_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace arris::bench {

std::string goal_table(const std::vector<GoalRow>& rows) {
  std::string text =
      "| case | part | asked | reached | worst scan | scans within | refused | "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const GoalRow& row : rows)
    text += fmt::format("| {} | {} | {} | {} | {} | {} of {} | {} | {} |\n", row.what, row.part, row.goal,
                        row.reached, row.worst, row.within, row.scans, row.refused,
                        row.met ? "met" : "**missed**");
  return text;
}

std::string notes_list(const std::vector<GoalRow>& rows) {
  std::string text;
  for (const GoalRow& row : rows) {
    std::map<std::string, int> counts;
    for (const std::string& note : row.notes) ++counts[note];
    for (const auto& [note, count] : counts)
      text += fmt::format("- {}, {}, {} of {}: {}\n", row.what, row.part, count, row.scans, note);
  }
  return text;
}

std::string text_of(const MeanMax& error) {
  return fmt::format("{:.3f} / {:.3f} mm", error.mean_mm, error.max_mm);
}

MeanMax medians(const std::vector<MeanMax>& accepted, std::size_t scans) {
  const auto middle = [&](double MeanMax::*member) {
    std::vector<double> values(scans, std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < accepted.size(); ++i) values[i] = accepted[i].*member;
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(scans - 1) / 2] + values[scans / 2]);
  };
  return {middle(&MeanMax::mean_mm), middle(&MeanMax::max_mm)};
}

void judge(GoalRow& row, const std::vector<MeanMax>& accepted, std::size_t refused, const MeanMax& limit) {
  row.scans = accepted.size() + refused;
  row.refused = refused;
  MeanMax mean, worst;
  for (const MeanMax& error : accepted) {
    mean.mean_mm += error.mean_mm / static_cast<double>(accepted.size());
    mean.max_mm += error.max_mm / static_cast<double>(accepted.size());
    worst.mean_mm = std::max(worst.mean_mm, error.mean_mm);
    worst.max_mm = std::max(worst.max_mm, error.max_mm);
    row.within += error.within(limit) ? 1U : 0U;
  }
  row.reached = accepted.empty() ? "-" : text_of(mean);
  row.worst = accepted.empty() ? "-" : text_of(worst);
  row.met = refused == 0 && !accepted.empty() && mean.within(limit);
}

}  // namespace arris::bench
