#include "tests/bench/accuracy/part_goals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace arris::bench {
namespace {

constexpr double kTimesBetterThanRigid = 20.0, kAxisDeg = 0.2;
constexpr MeanMax kBracketMedian{0.03, 0.07};

/// Of a part's usual scan, in edge limits.
MeanMax usual_goal(const std::string& part) {
  const bool is_small = part == "bracket" || part == "duct";
  return is_small ? MeanMax{0.35, 1.5} : MeanMax{0.2, 0.6};
}

MeanMax dense_goal_mm(const std::string& part) {
  return part == "duct" ? MeanMax{0.035, 0.13} : MeanMax{0.03, 0.1};
}

double mean_limit_mm(const CaseResult& result) {
  double sum_mm = 0.0;
  for (const Outcome& outcome : result.seeds) sum_mm += outcome.edge_limit_mm;
  return sum_mm / static_cast<double>(result.seeds.size());
}

std::vector<MeanMax> accepted_errors(const CaseResult& result) {
  std::vector<MeanMax> errors;
  for (const Outcome& outcome : result.seeds)
    if (outcome.error[kWhole])
      errors.push_back({outcome.error[kWhole]->mean_mm, outcome.error[kWhole]->max_mm});
  return errors;
}

GoalRow error_row(const CaseResult& result) {
  GoalRow row;
  row.what = result.scan;
  row.part = result.part;
  const std::vector<MeanMax> errors = accepted_errors(result);
  const std::size_t refused = result.seeds.size() - errors.size();
  if (result.goal == Goal::kDense) {
    const MeanMax limit_mm = dense_goal_mm(result.part);
    judge(row, errors, refused, limit_mm);
    row.goal = text_of(limit_mm);
    return row;
  }
  const MeanMax one = usual_goal(result.part);
  const double share = result.goal == Goal::kUsual ? 1.0 : 2.0, limit_mm = mean_limit_mm(result);
  const MeanMax goal_mm{share * one.mean_mm * limit_mm, share * one.max_mm * limit_mm};
  judge(row, errors, refused, goal_mm);
  row.goal = fmt::format("{} ({:.2f} / {:.1f} E)", text_of(goal_mm), share * one.mean_mm, share * one.max_mm);
  if (errors.empty()) return row;
  const Summary s = summary(result, kWhole);
  row.reached += fmt::format(" ({:.2f} / {:.2f} E)", s.mean_mm / limit_mm, s.max_mm / limit_mm);
  return row;
}

/// How many times as far as ours the best rigid motion's path is off, over the accepted scans.
GoalRow rigid_row(const CaseResult& result) {
  GoalRow row;
  row.what = "error of the best rigid motion there is over ours, " + result.scan;
  row.part = result.part;
  row.goal = fmt::format("{:.0f} times", kTimesBetterThanRigid);
  row.scans = result.seeds.size();
  double ours_mm = 0.0, rigid_mm = 0.0, least = std::numeric_limits<double>::infinity();
  for (const Outcome& outcome : result.seeds) {
    if (!outcome.error[kWhole]) {
      ++row.refused;
      continue;
    }
    ours_mm += outcome.error[kWhole]->mean_mm;
    rigid_mm += outcome.error[kBestRigid]->mean_mm;
    const double times = outcome.error[kBestRigid]->mean_mm / outcome.error[kWhole]->mean_mm;
    least = std::min(least, times);
    row.within += times >= kTimesBetterThanRigid ? 1U : 0U;
  }
  const bool any = row.refused < row.scans;
  row.reached = any ? fmt::format("{:.1f} times", rigid_mm / ours_mm) : "-";
  row.worst = any ? fmt::format("{:.1f} times", least) : "-";
  row.met = any && row.refused == 0 && rigid_mm / ours_mm >= kTimesBetterThanRigid;
  return row;
}

GoalRow median_row(const CaseResult& result) {
  GoalRow row;
  row.what = "median over the scans, " + result.scan;
  row.part = result.part;
  row.goal = text_of(kBracketMedian);
  const std::vector<MeanMax> errors = accepted_errors(result);
  judge(row, errors, result.seeds.size() - errors.size(), kBracketMedian);
  const MeanMax middle = medians(errors, row.scans);
  row.reached = text_of(middle);
  row.met = middle.within(kBracketMedian);
  return row;
}

GoalRow axis_row(const CaseResult& result) {
  GoalRow row;
  row.what = "tool axes, 95th percentile, " + result.scan;
  row.part = result.part;
  row.goal = fmt::format("{:.1f} degrees", kAxisDeg);
  row.scans = result.seeds.size();
  double sum_deg = 0.0, worst_deg = 0.0, count = 0.0;
  for (const Outcome& outcome : result.seeds) {
    if (!outcome.error[kWhole]) {
      ++row.refused;
      continue;
    }
    sum_deg += outcome.axis_p95_deg;
    worst_deg = std::max(worst_deg, outcome.axis_p95_deg);
    row.within += outcome.axis_p95_deg <= kAxisDeg ? 1U : 0U;
    count += 1.0;
  }
  row.reached = count > 0.0 ? fmt::format("{:.2f} degrees", sum_deg / count) : "-";
  row.worst = count > 0.0 ? fmt::format("{:.2f} degrees", worst_deg) : "-";
  row.met = count > 0.0 && row.refused == 0 && sum_deg / count <= kAxisDeg;
  return row;
}

std::string quantiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::string text;
  for (const double share : {0.05, 0.5, 0.95, 1.0})
    text += fmt::format(
        " {:.3f} |", values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)]);
  return text;
}

}  // namespace

std::vector<GoalRow> part_goals(const std::vector<CaseResult>& results) {
  std::vector<GoalRow> rows, more;
  for (const CaseResult& result : results) {
    if (result.goal == Goal::kNothing) continue;
    rows.push_back(error_row(result));
    if (result.goal == Goal::kTwice) continue;
    more.push_back(axis_row(result));
    if (result.goal != Goal::kUsual) continue;
    if (result.part == "bracket") more.push_back(median_row(result));
    if (result.part == "porthole" || result.part == "nosecone") more.push_back(rigid_row(result));
  }
  // Each case with its parts beside each other; the figures of other kinds after them.
  std::stable_sort(more.begin(), more.end(),
                   [](const GoalRow& a, const GoalRow& b) { return a.what < b.what; });
  std::vector<GoalRow> sorted;
  for (const GoalRow& first : rows) {
    if (std::any_of(sorted.begin(), sorted.end(), [&](const GoalRow& r) { return r.what == first.what; }))
      continue;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(sorted),
                 [&](const GoalRow& r) { return r.what == first.what; });
  }
  sorted.insert(sorted.end(), more.begin(), more.end());
  return sorted;
}

std::string distribution_table(const std::vector<CaseResult>& results) {
  std::string text =
      "| part | scan | mean: 5 % | median | 95 % | worst | max: 5 % | median | 95 % | worst | refused |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const CaseResult& result : results) {
    std::vector<double> means_mm, peaks_mm;
    for (const MeanMax& error : accepted_errors(result)) {
      means_mm.push_back(error.mean_mm);
      peaks_mm.push_back(error.max_mm);
    }
    const std::size_t refused = result.seeds.size() - means_mm.size();
    text += fmt::format("| {} | {} |", result.part, result.scan);
    text += means_mm.empty() ? " - | - | - | - | - | - | - | - |" : quantiles(means_mm) + quantiles(peaks_mm);
    text += fmt::format(" {} of {} |\n", refused, result.seeds.size());
  }
  return text;
}

std::string part_coverage_table(const std::vector<CaseResult>& results) {
  std::vector<std::string> parts;
  for (const CaseResult& result : results)
    if (std::find(parts.begin(), parts.end(), result.part) == parts.end()) parts.push_back(result.part);
  std::string text = coverage_heading();
  for (const std::string& part : parts) {
    CoverageTable table;
    for (const CaseResult& result : results)
      if (result.part == part)
        for (const Outcome& outcome : result.seeds) table.add(outcome.stated);
    text += coverage_rows(part, table);
  }
  return text;
}

}  // namespace arris::bench
