#include "tests/bench/pose/pose_trial.hpp"

#include <chrono>

#include "acquisition/clean.hpp"
#include "acquisition/geometry/rigid_fit.hpp"
#include "cli/prepare.hpp"
#include "registration/registration.hpp"

namespace arris::bench {
namespace {

constexpr double kCheckStepMm = 3.0;
constexpr double kAllowedOfBest = 1.5, kAllowedOfSize = 0.015, kAllowedOfSpacing = 0.75;

struct Truth {
  std::vector<Eigen::Vector3d> nominal_mm, true_mm;  ///< material points of all followed contours
  std::vector<Eigen::Vector3d> nominal_normal, true_normal;
  std::vector<Curve> curves;
};

Truth truth_of(const PosePart& part) {
  Truth truth;
  for (const int c : part.followed) {
    Contour curve;
    curve.closed = true;
    for (const synthetic::EdgePoint& p : part.shape->edge(c, kCheckStepMm)) {
      truth.nominal_mm.push_back(p.nominal_mm);
      truth.true_mm.push_back(p.true_mm);
      truth.nominal_normal.push_back(p.nominal_normal);
      truth.true_normal.push_back(p.true_normal);
      curve.points_mm.push_back(p.true_mm);
    }
    truth.curves.emplace_back(curve);
  }
  return truth;
}

/// Mean distance of the contours carried by a motion true_from_cad from the true curves.
double off_mm(const Truth& truth, const RigidMotion& true_from_cad) {
  double sum_mm = 0.0;
  for (const Eigen::Vector3d& p : truth.nominal_mm)
    sum_mm += nearest_contour(truth.curves, true_from_cad * p).foot.distance_mm;
  return sum_mm / static_cast<double>(truth.nominal_mm.size());
}

/// Normals of the carried contours against those of the part: the mean of their cosines is over 0 when the
/// right side is up, a part that lies turned over has it below.
bool same_side(const Truth& truth, const RigidMotion& true_from_cad) {
  Eigen::Vector3d nominal = Eigen::Vector3d::Zero(), deformed = nominal;
  for (std::size_t i = 0; i < truth.nominal_normal.size(); ++i) {
    nominal += truth.nominal_normal[i];
    deformed += truth.true_normal[i];
  }
  return (true_from_cad.linear() * nominal).dot(deformed) > 0.0;
}

synthetic::ScanOptions scan_options(const PosePart& part, synthetic::ScanOptions options) {
  if (part.whole_face) options.band_mm = 0.0;
  return options;
}

}  // namespace

std::vector<PoseScene> pose_scenes() {
  const auto scene = [](const char* name, auto&& change) {
    PoseScene made{name, {}};
    change(made.scan);
    return made;
  };
  return {
      scene("table and a clamp beside", [](auto& s) { s.clutter = true, s.around.table_below_mm = 40.0; }),
      scene("table 30 mm below, all round", [](auto& s) { s.around.table_below_mm = 30.0; }),
      scene("clamp across the edge, lumps", [](auto& s) { s.around.clamps = 1, s.around.blobs = 4; }),
      scene("one side beyond the view", [](auto& s) { s.around.beyond_view_ratio = 0.12; }),
      scene("patches missing, strays", [](auto& s) { s.missing_ratio = 0.12, s.stray_ratio = 0.03; }),
      scene("walls of the cut, uneven density",
            [](auto& s) { s.wall_ratio = 0.1, s.density_variation_ratio = 2.0; }),
      scene("all of it", [](auto& s) {
        s.clutter = true;
        s.around = {30.0, 1, 3, 0.06};
        s.missing_ratio = 0.05, s.stray_ratio = 0.02, s.wall_ratio = 0.05;
      })};
}

PoseTrial try_pose(const PosePart& part, const PoseScene& scene, std::uint64_t seed, int threads) {
  const synthetic::SyntheticScan sampled =
      synthetic::sample_scan(*part.shape, scan_options(part, scene.scan), seed);
  Scan scan;
  scan.cloud = clean(sampled.cloud(), {}).cloud;
  PrepareOptions preparing;
  preparing.threads = preparing.contour.threads = threads;
  ScanModel model = prepare_scan(scan, preparing).model;

  RegistrationOptions options;
  options.method = RegistrationMethod::kRigid;
  options.threads = options.coarse.threads = options.rigid.threads = threads;
  const auto before = std::chrono::steady_clock::now();
  const CoarseAlignment coarse = coarse_align(part.cad, model, options.coarse);
  PoseTrial trial;
  trial.search_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count();
  trial.reason = coarse.reason;
  trial.score_mm = coarse.score_mm;
  trial.runner_up_ratio = coarse.runner_up_ratio;
  trial.start = coarse.start;
  trial.equal_poses = coarse.equal_poses;
  if (!coarse.usable()) return trial;
  const Registration found = register_part(part.cad, model, options);
  if (!found.rigid.usable()) {
    trial.reason = found.refusals.empty() ? found.rigid.reason : found.refusals.front();
    return trial;
  }
  const Truth truth = truth_of(part);
  const RigidMotion true_from_cad = sampled.scan_from_cad.inverse() *
                                    Eigen::Translation3d(scan.cloud.offset_mm) * found.rigid.scan_from_cad;
  trial.off_mm = off_mm(truth, true_from_cad);
  trial.best_off_mm = off_mm(truth, fit_rigid(truth.nominal_mm, truth.true_mm).to_from);
  const double allowed_mm = kAllowedOfBest * trial.best_off_mm +
                            std::max(kAllowedOfSize * part.size_mm(), kAllowedOfSpacing * model.spacing_mm);
  const bool right = trial.off_mm <= allowed_mm && same_side(truth, true_from_cad);
  trial.verdict = right ? PoseVerdict::kRight : PoseVerdict::kWrong;
  return trial;
}

}  // namespace arris::bench
