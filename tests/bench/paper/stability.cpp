#include <fmt/format.h>

#include "tests/bench/paper/experiments.hpp"

namespace arris::bench {
namespace {

constexpr double kGaps[] = {0.0, 0.1, 0.2};

std::string word_of(StabilityPoints stability) {
  if (stability == StabilityPoints::kNone) return "none";
  return stability == StabilityPoints::kPaper ? "the paper's" : "local";
}

/// The paper's segments, or ours as one stage, with the stability points of `stability`.
Method stage(SegmentMatch match, StabilityPoints stability) {
  const bool is_paper = match == SegmentMatch::kPaper;
  return {(is_paper ? "the paper's matching, " : "ours by feet, ") + word_of(stability),
          [=](ScanTrial& trial) -> std::optional<CarriedPath> {
            SubdivisionIcpOptions options = paper_options(trial);
            options.match = match;
            options.stability = stability;
            const RigidMotion start = is_paper ? trial.paper_rigid() : trial.rigid().rigid.scan_from_cad;
            return trial.carried(
                subdivision_icp(trial.part().cad, trial.model(), trial.raw_edge(), start, options).front());
          }};
}

Method whole(StabilityPoints stability) {
  return {"the whole chain, " + word_of(stability), [=](ScanTrial& trial) {
            RegistrationOptions options = trial.options();
            options.method = RegistrationMethod::kSubdivision;
            options.subdivision.stability = stability;
            return trial.chain(options);
          }};
}

std::vector<Method> methods() {
  std::vector<Method> list;
  constexpr StabilityPoints kKinds[] = {StabilityPoints::kNone, StabilityPoints::kPaper,
                                        StabilityPoints::kLocal};
  for (const SegmentMatch match : {SegmentMatch::kPaper, SegmentMatch::kFoot})
    for (const StabilityPoints kind : kKinds) list.push_back(stage(match, kind));
  for (const StabilityPoints kind : kKinds) list.push_back(whole(kind));
  return list;
}

}  // namespace

std::string stability_section(const BenchPart& part, int seeds) {
  std::vector<std::vector<Tally>> by_gap;
  for (const double gap_ratio : kGaps) {
    synthetic::ScanOptions scan;
    scan.missing_ratio = gap_ratio;
    by_gap.push_back(compare(part, scan, methods(), seeds));
  }
  std::string text = fmt::format(
      "#### {}, stability points\n\nScan: {} points, noise 0.05 mm; seeds 1 to {}. Mean / largest error, "
      "mm:\n\n| matching, stability points | 0 % missing | 10 % missing | 20 % missing "
      "|\n|---|---|---|---|\n",
      part.fe.name(), part.fe.scan_points(), seeds);
  for (std::size_t m = 0; m < by_gap.front().size(); ++m) {
    text += "| " + by_gap.front()[m].method + " |";
    for (const std::vector<Tally>& tallies : by_gap) text += " " + short_cell(tallies[m]) + " |";
    text += "\n";
  }
  text += "\n";
  for (std::size_t g = 0; g < by_gap.size(); ++g) {
    const std::string refusals = refusal_list(by_gap[g]);
    if (!refusals.empty()) text += fmt::format("With {:.0f} % missing:\n\n{}\n", 100.0 * kGaps[g], refusals);
  }
  return text;
}

}  // namespace arris::bench
