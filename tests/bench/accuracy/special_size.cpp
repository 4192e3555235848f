#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/parallel_for.hpp"
#include "cli/results.hpp"
#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/scan.hpp"
#include "tests/bench/accuracy/special.hpp"
#include "tests/support/bench_part.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

using synthetic::PlatePart;
using synthetic::PlateShape;

constexpr double kSizeMm = 0.3;  // of the diameter, or between opposite sides
constexpr double kSpacingMm = 0.5, kBandMm = 30.0, kPathStepMm = 2.0, kCadEdgeMm = 4.0;
constexpr int kMostSeeds = 3;
constexpr MeanMax kPathGoal{0.02, 0.06};  // as of any part at this spacing
constexpr double kStatedGoalMm = 0.05;

PlateShape bent(PlateShape shape) {
  shape.bend_curvature_per_mm = 1.0 / 3000.0;
  shape.bend_axis_rad = 0.4;
  shape.twist_rad_per_mm = 1e-4;
  shape.band_mm = kBandMm;
  return shape;
}

/// The same plate, its hole larger by size_mm.
PlateShape moulded(PlateShape shape, double size_mm) {
  synthetic::PlateHole& hole = shape.holes.front();
  for (double* half_mm : {&hole.half_x_mm, &hole.half_y_mm, &hole.corner_radius_mm})
    *half_mm += 0.5 * size_mm;
  return shape;
}

ToolPath path_of(const synthetic::Part& part) {
  ToolPath path;
  for (const synthetic::EdgePoint& p : part.edge(0, kPathStepMm))
    path.points.push_back({p.nominal_mm, p.nominal_normal, 1, 0.0, true});
  return path;
}

/// What the report says of the hole: twice the mean of its contour errors, larger than drawn positive.
double stated_size_mm(const CadModel& cad, const Registration& found) {
  RunRecord record;
  judge_results(cad, found, record);
  double sum_mm = 0.0, count = 1e-9;
  for (const double across_mm : record.contour_errors.front().across_mm) {
    if (std::isnan(across_mm)) continue;
    sum_mm -= across_mm;  // positive towards the void: more material than drawn
    count += 1.0;
  }
  return 2.0 * sum_mm / count;
}

struct SizeOutcome {
  std::vector<std::string> reasons;
  MeanMax error;
  double stated_off_mm = 0.0;
};

SizeOutcome size_scan(const PlateShape& shape, double size_mm, std::uint64_t seed) {
  const PlatePart drawn(shape), real(moulded(shape, size_mm));
  synthetic::ScanOptions options;
  options.points = std::llround(real.band_area_mm2(kBandMm) / (kSpacingMm * kSpacingMm));
  const synthetic::SyntheticScan scan = sample_scan(real, options, seed);
  const PointCloud cloud = scan.cloud();
  const RigidMotion cad_from_local = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  std::vector<Contour> others;
  for (int c = 1; c < drawn.contour_count(); ++c) others.push_back(drawn.nominal_contour(c, 1.0));
  const CadModel cad = prepare_cad(drawn.cad_mesh(kCadEdgeMm), {drawn.nominal_contour(0, 1.0)}, others);
  const ToolPath path = path_of(drawn);
  Recipe recipe;
  recipe.part.thickness_mm = drawn.thickness_mm();
  RegistrationOptions registration = calibrated_options(recipe, 1);
  registration.coarse.initial_scan_from_cad =
      near_pose(cad_from_local.inverse(), cad.contours[0].point_mm(0.0), seed);
  const OneRun run = run_one({recipe, cad, path, 1}, cloud, registration);
  SizeOutcome outcome;
  outcome.reasons = run.reasons;
  if (!run.accepted()) return outcome;
  std::vector<Eigen::Vector3d> nominal_mm;
  for (const PathPoint& row : path.points) nominal_mm.push_back(row.tip_mm);
  const PathError error = Truth(real).error(nominal_mm, run.tips_mm(cad_from_local));
  outcome.error = {error.mean_mm, error.max_mm};
  outcome.stated_off_mm = std::abs(stated_size_mm(cad, run.found) - size_mm);
  return outcome;
}

/// Over size and under size, the seeds of each.
std::vector<SizeOutcome> size_scans(const PlateShape& shape, const SpecialSetup& setup) {
  const auto seeds = static_cast<std::size_t>(std::min(setup.seeds, kMostSeeds));
  std::vector<SizeOutcome> outcomes(2 * seeds);
  parallel_for(outcomes.size(), 1, setup.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      outcomes[i] = size_scan(shape, i < seeds ? kSizeMm : -kSizeMm, i % seeds + 1);
  });
  return outcomes;
}

void add_rows(const std::string& part, const PlateShape& shape, const SpecialSetup& setup,
              std::vector<GoalRow>& rows) {
  GoalRow path{.what = "hole 0.3 mm over or under size, h = 0.5 mm: path on the real edge", .part = part};
  path.goal = text_of(kPathGoal);
  GoalRow stated{.what = "the same: size error as reported, off by", .part = part};
  stated.goal = fmt::format("{:.2f} mm", kStatedGoalMm);
  std::vector<MeanMax> errors, off;
  std::size_t refused = 0;
  for (const SizeOutcome& outcome : size_scans(shape, setup)) {
    if (!outcome.reasons.empty()) {
      ++refused;
      path.notes.push_back(outcome.reasons.front());
      continue;
    }
    errors.push_back(outcome.error);
    off.push_back({outcome.stated_off_mm, outcome.stated_off_mm});
  }
  judge(path, errors, refused, kPathGoal);
  judge(stated, off, refused, {kStatedGoalMm, kStatedGoalMm});
  rows.push_back(std::move(path));
  rows.push_back(std::move(stated));
}

}  // namespace

std::vector<GoalRow> size_rows(const SpecialSetup& setup) {
  std::vector<GoalRow> rows;
  add_rows("plate, round hole", bent(synthetic::plate_with_circle()), setup, rows);
  add_rows("plate, rounded rectangle", bent(synthetic::plate_with_rounded_rectangle()), setup, rows);
  return rows;
}

}  // namespace arris::bench
