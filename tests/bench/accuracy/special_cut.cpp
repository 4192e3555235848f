#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "acquisition/geometry/parallel_for.hpp"
#include "fixtures/synthetic/scan.hpp"
#include "tests/bench/accuracy/special.hpp"
#include "tests/support/bench_part.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

constexpr int kMostSeeds = 5;
constexpr double kMeanMm = 0.3;
constexpr std::array kFreeWords = {"slide along", "turn about", "leaves these free"};

/// How an uncut part is scanned: its whole face at the density of its usual scan, or its usual band.
struct CutCase {
  bool whole_face = true, pose_given = false;
};

synthetic::ScanOptions uncut(const synthetic::Part& part, bool whole_face) {
  synthetic::ScanOptions options;
  options.uncut = true;
  if (!whole_face) return options;
  options.band_mm = 0.0;
  options.points = std::llround(static_cast<double>(part.scan_points()) * part.band_area_mm2(0.0) /
                                part.band_area_mm2(part.band_mm()));
  return options;
}

struct CutOutcome {
  std::vector<std::string> reasons;
  MeanMax error;
};

CutOutcome cut_scan(const BenchPart& part, const CutCase& cut, std::uint64_t seed) {
  const synthetic::SyntheticScan scan = sample_scan(part.fe, uncut(part.fe, cut.whole_face), seed);
  const PointCloud cloud = scan.cloud();
  const RigidMotion cad_from_local = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  RegistrationOptions options = calibrated_options(part.recipe, part.threads);
  if (cut.pose_given)
    options.coarse.initial_scan_from_cad = near_pose(cad_from_local.inverse(), part.path_mm.front(), seed);
  const OneRun run = run_one({part.recipe, part.cad, part.drawing.path, part.threads}, cloud, options);
  CutOutcome outcome;
  outcome.reasons = run.reasons;
  if (!run.found.usable()) return outcome;
  const PathError error = part.truth.error(part.path_mm, run.tips_mm(cad_from_local));
  outcome.error = {error.mean_mm, error.max_mm};
  return outcome;
}

std::vector<CutOutcome> cut_scans(const BenchPart& part, const CutCase& cut, const SpecialSetup& setup) {
  std::vector<CutOutcome> outcomes(static_cast<std::size_t>(std::min(setup.seeds, kMostSeeds)));
  parallel_for(outcomes.size(), 1, setup.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) outcomes[i] = cut_scan(part, cut, i + 1);
  });
  return outcomes;
}

GoalRow held_row(const BenchPart& part, const std::string& what, const CutCase& cut,
                 const SpecialSetup& setup) {
  GoalRow row{.what = what, .part = part.fe.name()};
  row.goal = fmt::format("mean {:.1f} mm", kMeanMm);
  std::vector<MeanMax> errors;
  for (const CutOutcome& outcome : cut_scans(part, cut, setup)) {
    if (outcome.reasons.empty())
      errors.push_back(outcome.error);
    else
      row.notes.push_back(outcome.reasons.front());
  }
  judge(row, errors, row.notes.size(), {kMeanMm, std::numeric_limits<double>::infinity()});
  return row;
}

/// The first reason that names a free motion; empty: none does.
std::string named_motion(const std::vector<std::string>& reasons) {
  for (const std::string& reason : reasons)
    for (const char* words : kFreeWords)
      if (reason.find(words) != std::string::npos) return reason;
  return {};
}

/// A scan that has to be refused; motion_named: in words that name what is free.
GoalRow refused_row(const BenchPart& part, const std::string& what, const CutCase& cut, bool motion_named,
                    const SpecialSetup& setup) {
  GoalRow row{.what = what, .part = part.fe.name()};
  row.goal = motion_named ? "refused, the free motion named" : "refused";
  double worst_mm = 0.0;
  for (const CutOutcome& outcome : cut_scans(part, cut, setup)) {
    ++row.scans;
    if (outcome.reasons.empty()) {
      worst_mm = std::max(worst_mm, outcome.error.max_mm);
      continue;
    }
    ++row.refused;
    const std::string named = named_motion(outcome.reasons);
    row.within += motion_named && named.empty() ? 0U : 1U;
    row.notes.push_back(named.empty() ? outcome.reasons.front() : named);
  }
  row.reached = fmt::format("{} of {}", row.within, row.scans);
  row.worst = row.refused == row.scans ? "-" : fmt::format("accepted, {:.3f} mm off", worst_mm);
  row.met = row.within == row.scans;
  return row;
}

}  // namespace

std::vector<GoalRow> cut_rows(const SpecialSetup& setup) {
  std::vector<GoalRow> rows;
  BenchPart porthole(setup.fixtures / "porthole", 1), sheet(setup.fixtures / "sheet", 1);
  porthole.recipe.contour.role = sheet.recipe.contour.role = "cut";
  rows.push_back(held_row(porthole, "role cut, whole face scanned, not cut yet", {}, setup));
  rows.push_back(held_row(sheet, "role cut, whole face scanned, not cut yet, pose given",
                          {.whole_face = true, .pose_given = true}, setup));
  rows.push_back(
      refused_row(sheet, "the same, no pose given: its outline looks alike half turned", {}, false, setup));
  for (const BenchPart* part : {&porthole, &sheet})
    rows.push_back(refused_row(*part, "role cut, band scanned, nothing holds the slide",
                               {.whole_face = false, .pose_given = false}, true, setup));
  return rows;
}

}  // namespace arris::bench
