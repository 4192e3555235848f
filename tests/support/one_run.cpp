#include "tests/support/one_run.hpp"

#include "cli/recipe_options.hpp"
#include "fixtures/synthetic/random.hpp"
#include "tests/support/bench_part.hpp"

namespace arris::bench {
namespace {

constexpr double kPoseTurnRad = 0.09, kPoseShiftMm = 10.0;

}  // namespace

RegistrationOptions calibrated_options(const Recipe& recipe, int threads) {
  RegistrationOptions options = registration_options(recipe, threads);
  options.edge.scanner = options.surface.scanner = {0.0, 0.0};
  return options;
}

std::vector<Eigen::Vector3d> OneRun::tips_mm(const RigidMotion& to_from_local) const {
  std::vector<Eigen::Vector3d> tips;
  for (const CorrectedPoint& row : correction.points) tips.push_back(to_from_local * row.point.tip_mm);
  return tips;
}

OneRun run_one(const RunInputs& inputs, const PointCloud& cloud, const RegistrationOptions& options) {
  OneRun run;
  PreparedScan prepared = prepare(inputs.recipe, inputs.threads, cloud);
  run.found = register_part(inputs.cad, prepared.model, options);
  run.reasons = run.found.refusals;
  if (!run.found.usable()) return run;
  run.correction = correct(inputs.path, inputs.cad.surface, *run.found.field, run.found.rigid.scan_from_cad,
                           correct_options(inputs.recipe, inputs.threads));
  run.reasons.insert(run.reasons.end(), run.correction.reasons.begin(), run.correction.reasons.end());
  return run;
}

RigidMotion near_pose(const RigidMotion& local_from_cad, const Eigen::Vector3d& about_mm, std::uint64_t seed,
                      double share_ratio) {
  synthetic::Random random(seed + 500000);
  const Eigen::AngleAxisd turn(share_ratio * random.uniform(0.0, kPoseTurnRad), random.direction());
  const Eigen::Vector3d shift_mm = share_ratio * random.uniform(0.0, kPoseShiftMm) * random.direction();
  return local_from_cad *
         (Eigen::Translation3d(about_mm + shift_mm) * turn * Eigen::Translation3d(-about_mm));
}

}  // namespace arris::bench
