#include <fmt/format.h>

#include <algorithm>

#include "acquisition/geometry/parallel_for.hpp"
#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/scan.hpp"
#include "tests/bench/accuracy/special.hpp"
#include "tests/support/bench_part.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

using synthetic::EdgePoint;
using synthetic::PlatePart;

constexpr double kThicknessMm = 10.0, kPathStepMm = 2.0, kTruthStepMm = 0.25, kCadEdgeMm = 8.0;
constexpr std::int64_t kPoints = 24000;
constexpr double kWallRatio = 0.02;  // points on the wall of the cut a face point: one for each mm of rim
constexpr double kMoreMm = 0.02;

PlatePart thick_plate() {
  synthetic::PlateShape shape = synthetic::asymmetric_plate();
  shape.thickness_mm = kThicknessMm;
  shape.bend_curvature_per_mm = 1.0 / 1500.0;
  shape.twist_rad_per_mm = 0.0;  // so that fibres stand on every layer
  return PlatePart(shape);
}

/// On the rim of a face, the axes out of that face.
ToolPath path_on(const PlatePart& part, bool far) {
  ToolPath path;
  for (const EdgePoint& p : part.edge_at_depth(0, kPathStepMm, far ? kThicknessMm : 0.0))
    path.points.push_back({p.nominal_mm, (far ? -1.0 : 1.0) * p.nominal_normal, 1, 0.0, true});
  if (far) std::reverse(path.points.begin(), path.points.end());  // material on the left, seen from there
  return path;
}

struct FaceOutcome {
  std::vector<std::string> reasons;
  MeanMax error;
};

FaceOutcome face_scan(const PlatePart& part, const CadModel& cad, bool walls, bool far, std::uint64_t seed) {
  synthetic::ScanOptions options;
  options.points = kPoints;
  options.band_mm = 0.0;  // the holes beside the opening tell its two turns apart
  options.wall_ratio = walls ? kWallRatio : 0.0;
  const synthetic::SyntheticScan scan = sample_scan(part, options, seed);
  const PointCloud cloud = scan.cloud();
  const RigidMotion cad_from_local = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  Recipe recipe;
  recipe.part.thickness_mm = kThicknessMm;
  recipe.toolpath.face = far ? "other" : "scanned";
  const ToolPath path = path_on(part, far);
  const OneRun run = run_one({recipe, cad, path, 1}, cloud, calibrated_options(recipe, 1));
  FaceOutcome outcome;
  outcome.reasons = run.reasons;
  if (!run.accepted()) return outcome;
  std::vector<Eigen::Vector3d> nominal_mm;
  for (const PathPoint& row : path.points) nominal_mm.push_back(row.tip_mm);
  const Truth truth(part.edge_at_depth(0, kTruthStepMm, far ? kThicknessMm : 0.0));
  const PathError error = truth.error(nominal_mm, run.tips_mm(cad_from_local));
  outcome.error = {error.mean_mm, error.max_mm};
  return outcome;
}

struct FaceScans {
  std::vector<MeanMax> errors;
  std::vector<std::string> reasons;  ///< one a refused scan
};

FaceScans face_scans(const PlatePart& part, const CadModel& cad, bool walls, bool far,
                     const SpecialSetup& setup) {
  std::vector<FaceOutcome> outcomes(static_cast<std::size_t>(setup.seeds));
  parallel_for(outcomes.size(), 1, setup.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) outcomes[i] = face_scan(part, cad, walls, far, i + 1);
  });
  FaceScans scans;
  for (const FaceOutcome& outcome : outcomes)
    if (outcome.reasons.empty())
      scans.errors.push_back(outcome.error);
    else
      scans.reasons.push_back(outcome.reasons.front());
  return scans;
}

MeanMax mean_of(const std::vector<MeanMax>& errors) {
  MeanMax mean;
  for (const MeanMax& error : errors) {
    mean.mean_mm += error.mean_mm / static_cast<double>(errors.size());
    mean.max_mm += error.max_mm / static_cast<double>(errors.size());
  }
  return mean;
}

}  // namespace

std::vector<GoalRow> face_rows(const SpecialSetup& setup) {
  const PlatePart part = thick_plate();
  std::vector<Contour> others;
  for (int c = 1; c < part.contour_count(); ++c) others.push_back(part.nominal_contour(c, 1.0));
  const CadModel cad = prepare_cad(part.cad_mesh(kCadEdgeMm), {part.nominal_contour(0, 1.0)}, others);
  const MeanMax without = mean_of(face_scans(part, cad, false, false, setup).errors);
  const MeanMax limit{without.mean_mm + kMoreMm, without.max_mm + kMoreMm};
  std::vector<GoalRow> rows;
  for (const bool far : {false, true}) {
    GoalRow row{.what = far ? "walls in the scan, path on the far face" : "walls in the scan",
                .part = "plate of 10 mm"};
    row.goal = fmt::format("{} (without {})", text_of(limit), text_of(without));
    FaceScans scans = face_scans(part, cad, true, far, setup);
    row.notes = std::move(scans.reasons);
    judge(row, scans.errors, row.notes.size(), limit);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace arris::bench
