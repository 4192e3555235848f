#include "tests/bench/trust/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

namespace arris::bench {
namespace {

using Value = std::function<double(const StudyOutcome&)>;

bool accepted(const StudyOutcome& outcome) {
  return outcome.has_path && outcome.refusals.empty();
}

const StudyResult* of(const std::vector<StudyResult>& results, StudyCase study_case) {
  for (const StudyResult& result : results)
    if (result.study_case == study_case) return &result;
  return nullptr;
}

std::vector<double> sorted(const StudyResult& result, const Value& value) {
  std::vector<double> values;
  for (const StudyOutcome& outcome : result.seeds)
    if (accepted(outcome)) values.push_back(value(outcome));
  std::sort(values.begin(), values.end());
  return values;
}

double quantile(const std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

double mean(const std::vector<double>& values) {
  return values.empty() ? 0.0 : std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// Met on how many of all seeds; refused ones are not.
std::string reached(const StudyResult& result, const std::function<bool(const StudyOutcome&)>& good) {
  const auto count = std::count_if(result.seeds.begin(), result.seeds.end(),
                                   [&](const StudyOutcome& o) { return accepted(o) && good(o); });
  return fmt::format("{} of {}", count, result.seeds.size());
}

std::string row(const StudyResult& result, const std::string& what, const Value& value, double limit) {
  const std::vector<double> values = sorted(result, value);
  return fmt::format("| {} | {} | {:.3g} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {} |\n",
                     words_of(result.study_case).name, what, limit, mean(values), quantile(values, 0.5),
                     quantile(values, 0.95), quantile(values, 1.0),
                     reached(result, [&](const StudyOutcome& o) { return value(o) <= limit; }));
}

/// A case beside the same seed's complete scan.
std::string against_complete(const StudyResult& result, const StudyResult& complete, const std::string& what,
                             double limit, const std::function<double(double, double)>& compare) {
  std::map<std::uint64_t, double> clean;
  for (const StudyOutcome& outcome : complete.seeds)
    if (accepted(outcome)) clean[outcome.seed] = outcome.rms_mm;
  return row(
      result, what,
      [&](const StudyOutcome& o) {
        const auto at = clean.find(o.seed);
        return at == clean.end() ? 1e9 : compare(o.rms_mm, at->second);
      },
      limit);
}

void add_coverage(const std::string& name, const std::vector<const StudyOutcome*>& outcomes,
                  std::string& text) {
  CoverageTable table;
  for (const StudyOutcome* outcome : outcomes)
    if (accepted(*outcome)) table.add(outcome->rows);
  text += coverage_rows(name, table);
}

}  // namespace

std::string figure_table(const std::vector<StudyResult>& results) {
  std::string text =
      "| case | figure | at most | mean | median | 95 % | worst | met by "
      "|\n|---|---|---|---|---|---|---|---|\n";
  const auto rms = [](const StudyOutcome& o) { return o.rms_mm; };
  const auto max = [](const StudyOutcome& o) { return o.max_mm; };
  const StudyResult* complete = of(results, StudyCase::kComplete);
  for (const StudyResult* whole : {complete, of(results, StudyCase::kIndependent)}) {
    if (!whole) continue;
    text += row(*whole, "rms, mm", rms, 0.02) + row(*whole, "max, mm", max, 0.06);
    text += row(
        *whole, "normals, 95th percentile, degrees", [](const StudyOutcome& o) { return o.normal_p95_deg; },
        0.2);
  }
  if (const StudyResult* ten = of(results, StudyCase::kTenMissing)) {
    text += row(*ten, "max, mm", max, 0.08);
    const auto over = [](double ours, double theirs) { return theirs > 0.0 ? ours / theirs : 0.0; };
    text += row(
        *ten, "max in the gap over subdivision ICP's there",
        [&](const StudyOutcome& o) { return over(o.gap_max_mm, o.subdivision_gap_max_mm); }, 0.1);
    text += row(
        *ten, "the same, subdivision ICP with the paper's matching and stability points",
        [&](const StudyOutcome& o) { return over(o.gap_max_mm, o.paper_gap_max_mm); }, 0.1);
  }
  if (const StudyResult* twenty = of(results, StudyCase::kTwentyMissing))
    text += row(
        *twenty, "rms in the gap, mm", [](const StudyOutcome& o) { return o.gap_rms_mm; }, 0.3);
  const StudyResult* strays = of(results, StudyCase::kStrays);
  if (strays && complete)
    text += against_complete(*strays, *complete, "rms over that of the complete scan", 1.5,
                             [](double ours, double clean) { return ours / clean; });
  const StudyResult* burrs = of(results, StudyCase::kBurrs);
  if (burrs && complete)
    text += against_complete(*burrs, *complete, "rms more than that of the complete scan, mm", 0.05,
                             [](double ours, double clean) { return ours - clean; });
  return text;
}

std::string distribution_table(const std::vector<StudyResult>& results) {
  std::string text =
      "| case | error | 5 % | 25 % | median | 75 % | 95 % | worst | refused "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const StudyResult& result : results)
    for (const bool peak : {false, true}) {
      const std::vector<double> values =
          sorted(result, [&](const StudyOutcome& o) { return peak ? o.max_mm : o.rms_mm; });
      text += fmt::format("| {} | {} |", words_of(result.study_case).name, peak ? "max" : "rms");
      for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95, 1.0})
        text += fmt::format(" {:.3f} |", quantile(values, share));
      text += fmt::format(" {} of {} |\n", result.seeds.size() - values.size(), result.seeds.size());
    }
  return text;
}

std::string study_coverage_table(const std::vector<StudyResult>& results) {
  std::string text = coverage_heading();
  std::map<std::string, std::vector<const StudyOutcome*>> kinds;
  std::vector<const StudyOutcome*> all;
  for (const StudyResult& result : results) {
    std::vector<const StudyOutcome*> outcomes;
    for (const StudyOutcome& outcome : result.seeds) {
      outcomes.push_back(&outcome);
      all.push_back(&outcome);
      kinds[outcome.kind].push_back(&outcome);
    }
    add_coverage(words_of(result.study_case).name, outcomes, text);
  }
  for (const auto& [kind, outcomes] : kinds) add_coverage("parts: " + kind, outcomes, text);
  add_coverage("**all**", all, text);
  return text;
}

std::string refusal_list(const std::vector<StudyResult>& results) {
  std::string text;
  for (const StudyResult& result : results)
    for (const StudyOutcome& outcome : result.seeds) {
      if (accepted(outcome)) continue;
      text +=
          fmt::format("- seed {}, {}, {}: {}", outcome.seed, outcome.kind, words_of(result.study_case).name,
                      outcome.refusals.empty() ? "no field" : outcome.refusals.front());
      if (outcome.has_path)
        text += fmt::format(" (it would have been off by {:.3f} mm at most)", outcome.max_mm);
      text += "\n";
    }
  return text.empty() ? "None was refused.\n" : text;
}

}  // namespace arris::bench
