#include <fmt/format.h>

#include "tests/bench/paper/experiments.hpp"

namespace arris::bench {
namespace {

constexpr double kGaps[] = {0.0, 0.1, 0.2};

/// Each matching has stability points of its own kind: the paper's are all in every segment and matched once,
/// those of matching by feet are near their segment and matched again each round.
std::string name_of(const std::string& matching, SegmentMatch match, bool has_points) {
  if (!has_points) return matching + ", none";
  return matching + (match == SegmentMatch::kPaper ? ", the paper's" : ", local");
}

StabilityPoints kind_of(SegmentMatch match, bool has_points) {
  if (!has_points) return StabilityPoints::kNone;
  return match == SegmentMatch::kPaper ? StabilityPoints::kPaper : StabilityPoints::kLocal;
}

/// Subdivision ICP as one stage, on the edge points as extracted.
Method stage(SegmentMatch match, bool has_points) {
  const bool is_paper = match == SegmentMatch::kPaper;
  return {name_of(is_paper ? "the paper's matching" : "matching by feet", match, has_points),
          [=](ScanTrial& trial) -> std::optional<CarriedPath> {
            SubdivisionIcpOptions options = paper_options(trial);
            options.match = match;
            options.stability = kind_of(match, has_points);
            const RigidMotion start = is_paper ? trial.paper_rigid() : trial.rigid().rigid.scan_from_cad;
            return trial.carried(
                subdivision_icp(trial.part().cad, trial.model(), trial.raw_edge(), start, options).front());
          }};
}

Method whole(bool has_points) {
  return {name_of("the whole chain", SegmentMatch::kFoot, has_points), [=](ScanTrial& trial) {
            RegistrationOptions options = trial.options();
            options.method = RegistrationMethod::kSubdivision;
            options.subdivision.stability = kind_of(SegmentMatch::kFoot, has_points);
            return trial.chain(options);
          }};
}

std::vector<Method> methods() {
  std::vector<Method> list;
  for (const SegmentMatch match : {SegmentMatch::kPaper, SegmentMatch::kFoot})
    for (const bool has_points : {false, true}) list.push_back(stage(match, has_points));
  for (const bool has_points : {false, true}) list.push_back(whole(has_points));
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
