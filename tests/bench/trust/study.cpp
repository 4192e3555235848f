#include "tests/bench/trust/study.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/bench_part.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

constexpr double kSpacingMm = 0.5, kPathStepMm = 2.0,
                 kCadEdgeMm = 4.0;  // coarser, the arcs of small corners fold triangles

synthetic::ScanOptions scan_options(const StudyPart& study, StudyCase study_case) {
  synthetic::ScanOptions options;
  const synthetic::Part& part = *study.part;
  options.points = std::llround(part.band_area_mm2(part.band_mm()) / (kSpacingMm * kSpacingMm));
  if (study_case != StudyCase::kIndependent) options.noise_length_mm = study.noise_length_mm;
  if (study_case == StudyCase::kTenMissing) options.missing_ratio = 0.1;
  if (study_case == StudyCase::kTwentyMissing) options.missing_ratio = 0.2;
  if (study_case == StudyCase::kStrays) {
    options.stray_ratio = 0.3;
    options.stray_reach_mm = 30.0;
  }
  if (study_case == StudyCase::kBurrs) options.burr_ratio = 0.1;
  return options;
}

CadModel drawing_of(const synthetic::Part& part) {
  std::vector<Contour> others;
  for (int c = 1; c < part.contour_count(); ++c) others.push_back(part.nominal_contour(c, 1.0));
  return prepare_cad(part.cad_mesh(kCadEdgeMm), {part.nominal_contour(0, 1.0)}, others);
}

NominalRows path_on(const Curve& contour) {
  NominalRows path;
  for (double s_mm = 0.0; s_mm < contour.length_mm(); s_mm += kPathStepMm) {
    path.points_mm.push_back(contour.point_mm(s_mm));
    path.normals.push_back(contour.normal(s_mm));
  }
  return path;
}

double distance_mm(const StatedError& row) {
  return std::hypot(row.error[StatedError::kNormal], row.error[StatedError::kAcross]);
}

void sum_up(StudyOutcome& outcome) {
  double sum2 = 0.0, gap_sum2 = 0.0, gap_count = 1e-9;
  for (const StatedError& row : outcome.rows) {
    const double off_mm = distance_mm(row);
    sum2 += off_mm * off_mm;
    outcome.max_mm = std::max(outcome.max_mm, off_mm);
    if (!row.in_gap) continue;
    gap_sum2 += off_mm * off_mm;
    gap_count += 1.0;
    outcome.gap_max_mm = std::max(outcome.gap_max_mm, off_mm);
  }
  outcome.rms_mm = std::sqrt(sum2 / static_cast<double>(outcome.rows.size()));
  outcome.gap_rms_mm = std::sqrt(gap_sum2 / gap_count);
  outcome.normal_p95_deg = axis_p95_deg(outcome.rows);
}

}  // namespace

StudyCaseWords words_of(StudyCase study_case) {
  switch (study_case) {
    case StudyCase::kComplete:
      return {"complete", "complete"};
    case StudyCase::kIndependent:
      return {"independent", "complete, noise independent from point to point"};
    case StudyCase::kTenMissing:
      return {"ten", "10 % of contour and band missing"};
    case StudyCase::kTwentyMissing:
      return {"twenty", "20 % missing"};
    case StudyCase::kStrays:
      return {"strays", "30 % strays within 30 mm of the edge"};
    case StudyCase::kBurrs:
      return {"burrs", "burrs of 0.5 to 3 mm on 10 % of the edge"};
  }
  return {};
}

StudyOutcome study_scan(const StudyPart& study, StudyCase study_case, std::uint64_t seed, int threads) {
  StudyOutcome outcome;
  outcome.seed = seed;
  outcome.kind = study.kind;
  const synthetic::SyntheticScan scan = sample_scan(*study.part, scan_options(study, study_case), seed);
  const Truth truth(*study.part);
  const CadModel cad = drawing_of(*study.part);
  const NominalRows path = path_on(cad.contours[0]);
  Recipe recipe;  // what the program does when a recipe names none of registration's options
  recipe.part.thickness_mm = study.part->thickness_mm();
  const PointCloud cloud = scan.cloud();
  const RigidMotion cad_from_local = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  PreparedScan prepared = prepare(recipe, threads, cloud);
  RegistrationOptions options = calibrated_options(recipe, threads);
  // A half-turned hole looks the same, and finding poses is another study's matter.
  options.coarse.initial_scan_from_cad =
      near_pose(cad_from_local.inverse(), cad.contours[0].point_mm(0.0), seed);
  const Registration found = register_part(cad, prepared.model, options);
  outcome.refusals = found.refusals;
  outcome.has_path = found.usable();
  if (found.usable()) {
    outcome.rows = stated_errors(truth, *found.field, scan, cad_from_local, path);
    sum_up(outcome);
  }
  if (study_case != StudyCase::kTenMissing) return outcome;
  options.method = RegistrationMethod::kSubdivision;
  const auto gap_max_mm = [&] {
    const Registration baseline = register_part(cad, prepared.model, options);
    double most_mm = 0.0;
    if (!baseline.usable()) return most_mm;
    for (const StatedError& row : stated_errors(truth, *baseline.field, scan, cad_from_local, path))
      if (row.in_gap) most_mm = std::max(most_mm, distance_mm(row));
    return most_mm;
  };
  outcome.subdivision_gap_max_mm = gap_max_mm();
  options.subdivision.match = SegmentMatch::kPaper;
  options.subdivision.stability = StabilityPoints::kPaper;
  outcome.paper_gap_max_mm = gap_max_mm();
  return outcome;
}

}  // namespace arris::bench
