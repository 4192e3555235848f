#include <fmt/format.h>

#include <cmath>

#include "tests/bench/paper/experiments.hpp"

namespace arris::bench {
namespace {

constexpr double kSpacingsMm[] = {5.0, 2.0, 1.0, 0.5};
constexpr double kFinestQuickMm = 2.0;

std::vector<Method> methods() {
  std::vector<Method> list = {rigid_icp()};
  for (Method& method : projections()) list.push_back(std::move(method));
  list.push_back(paper_subdivision());
  list.push_back(subdivision());
  for (Method& method : joint_fits()) list.push_back(std::move(method));
  return list;
}

/// One spacing: what the scan can show, and what each method makes of it.
struct Rung {
  double spacing_mm = 0.0, edge_limit_mm = 0.0;
  std::int64_t points = 0;
  std::vector<Tally> tallies;
};

Rung climb(const BenchPart& part, double spacing_mm, int seeds) {
  Rung rung{spacing_mm, spacing_mm * spacing_mm / 50.0, 0, {}};
  synthetic::ScanOptions scan;
  rung.points = scan.points =
      std::llround(part.fe.band_area_mm2(part.fe.band_mm()) / (spacing_mm * spacing_mm));
  rung.tallies = compare(part, scan, methods(), seeds);
  return rung;
}

std::string split_cell(const Tally& tally) {
  if (tally.errors.empty()) return "-";
  return fmt::format("{:.3f} / {:.3f}", tally.mean_mm(&PathError::normal_mm),
                     tally.mean_mm(&PathError::across_mm));
}

std::string ladder(const std::vector<Rung>& rungs, const std::function<std::string(const Tally&)>& cell) {
  std::string text = "| |", line = "|---|", points = "| points |", limit = "| E, mm |";
  for (const Rung& rung : rungs) {
    text += fmt::format(" {:.1f} mm |", rung.spacing_mm);
    line += "---|";
    points += fmt::format(" {} |", rung.points);
    limit += fmt::format(" {:.3f} |", rung.edge_limit_mm);
  }
  text += "\n" + line + "\n" + points + "\n" + limit + "\n";
  for (std::size_t m = 0; m < rungs.front().tallies.size(); ++m) {
    text += "| " + rungs.front().tallies[m].method + " |";
    for (const Rung& rung : rungs) text += " " + cell(rung.tallies[m]) + " |";
    text += "\n";
  }
  return text + "\n";
}

}  // namespace

std::string density_section(const BenchPart& part, int seeds, bool quick) {
  std::vector<Rung> rungs;
  for (const double spacing_mm : kSpacingsMm)
    if (!quick || spacing_mm >= kFinestQuickMm) rungs.push_back(climb(part, spacing_mm, seeds));
  std::string text = fmt::format(
      "#### {}, spacing of the scan\n\nNoise 0.05 mm, nothing missing; seeds 1 to {}. Mean / largest error, "
      "mm:\n\n",
      part.fe.name(), seeds);
  text += ladder(rungs, short_cell) + "The same errors' mean parts, normal / across, mm:\n\n" +
          ladder(rungs, split_cell);
  for (const Rung& rung : rungs) {
    const std::string refusals = refusal_list(rung.tallies);
    if (!refusals.empty()) text += fmt::format("At {:.1f} mm:\n\n{}\n", rung.spacing_mm, refusals);
  }
  return text;
}

}  // namespace arris::bench
