#include "tests/bench/paper/tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace arris::bench {
namespace {

/// A reason with its numbers replaced, so that the same one counts as the same on all seeds.
std::string without_numbers(const std::string& reason) {
  std::string text;
  for (const char c : reason) {
    const bool is_number =
        std::isdigit(static_cast<unsigned char>(c)) != 0 || (c == '.' && !text.empty() && text.back() == '#');
    if (!is_number)
      text += c;
    else if (text.empty() || text.back() != '#')
      text += '#';
  }
  return text;
}

std::string percent(double ratio) {
  return fmt::format("{:.0f} %", 100.0 * ratio);
}

std::string row_of(const Tally& tally, const Tally& base) {
  if (tally.errors.empty())
    return fmt::format("| {} | - | - | - | - | - | - | {} of {} |\n", tally.method, tally.refused(),
                       tally.seeds);
  const double mean_mm = tally.mean_mm(&PathError::mean_mm), max_mm = tally.mean_mm(&PathError::max_mm);
  return fmt::format("| {} | {:.3f} ({:.3f}) | {:.3f} ({:.3f}) | {:.3f} | {:.3f} | {} | {} | {} of {} |\n",
                     tally.method, mean_mm, tally.worst_mm(&PathError::mean_mm), max_mm,
                     tally.worst_mm(&PathError::max_mm), tally.mean_mm(&PathError::normal_mm),
                     tally.mean_mm(&PathError::across_mm),
                     percent(mean_mm / base.mean_mm(&PathError::mean_mm)),
                     percent(max_mm / base.mean_mm(&PathError::max_mm)), tally.refused(), tally.seeds);
}

}  // namespace

int Tally::refused() const {
  int count = 0;
  for (const auto* counted : {&refusals, &failures})
    for (const auto& [reason, seeds] : *counted) count += seeds;
  return count;
}

double Tally::mean_mm(double PathError::*member) const {
  double sum = 0.0;
  for (const PathError& error : errors) sum += error.*member;
  return sum / static_cast<double>(std::max<std::size_t>(1, errors.size()));
}

double Tally::worst_mm(double PathError::*member) const {
  double worst = 0.0;
  for (const PathError& error : errors) worst = std::max(worst, error.*member);
  return worst;
}

std::vector<Tally> compare(const BenchPart& part, const synthetic::ScanOptions& options,
                           const std::vector<Method>& methods, int seeds) {
  std::vector<Tally> tallies(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) tallies[m].method = methods[m].name;
  for (int seed = 1; seed <= seeds; ++seed) {
    const synthetic::SyntheticScan scan = sample_scan(part.fe, options, static_cast<std::uint64_t>(seed));
    ScanTrial trial(part, scan);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::optional<CarriedPath> path =
          trial.has_pose() ? methods[m].carry(trial) : std::optional<CarriedPath>();
      ++tallies[m].seeds;
      if (!path) {
        const Registration& rigid = trial.rigid();
        const std::string why = rigid.coarse.usable() ? rigid.rigid.reason : rigid.coarse.reason;
        ++tallies[m].failures[why.empty() ? "no field" : without_numbers(why)];
        continue;
      }
      tallies[m].errors.push_back(part.truth.error(part.path_mm, path->tips_mm));
      if (!path->reasons.empty()) ++tallies[m].refusals[without_numbers(path->reasons.front())];
    }
  }
  return tallies;
}

std::string refusal_list(const std::vector<Tally>& tallies) {
  std::string text;
  for (const Tally& tally : tallies) {
    for (const auto& [reason, seeds] : tally.refusals)
      text += fmt::format("- {}: refused {} times: {}\n", tally.method, seeds, reason);
    for (const auto& [reason, seeds] : tally.failures)
      text += fmt::format("- {}: no path {} times: {}\n", tally.method, seeds, reason);
  }
  return text;
}

std::string error_table(const std::vector<Tally>& tallies, const std::string& base) {
  const auto found =
      std::find_if(tallies.begin(), tallies.end(), [&](const Tally& tally) { return tally.method == base; });
  std::string text =
      "| | mean (worst) | max (worst) | normal | across | mean, of rigid ICP's | max, of rigid ICP's | "
      "refused "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const Tally& tally : tallies) text += row_of(tally, *found);
  const std::string refusals = refusal_list(tallies);
  return text + (refusals.empty() ? "" : "\n" + refusals);
}

std::string short_cell(const Tally& tally) {
  if (tally.errors.empty()) return "no result";
  std::string text =
      fmt::format("{:.3f} / {:.3f}", tally.mean_mm(&PathError::mean_mm), tally.mean_mm(&PathError::max_mm));
  const int refused = tally.refused();
  return refused == 0 ? text : text + fmt::format(", {} refused", refused);
}

}  // namespace arris::bench
