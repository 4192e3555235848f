#include "tests/bench/pose/pose_trial.hpp"

#include <chrono>

#include "acquisition/clean.hpp"
#include "acquisition/geometry/rigid_fit.hpp"
#include "cli/prepare.hpp"
#include "registration/registration.hpp"

namespace arris::bench {
namespace {

constexpr double kCheckStepMm = 3.0;
constexpr double kOfBest = 0.5;    // of the spacing: beyond this the field has to show what it makes of it
constexpr double kOfField = 0.25;  // of the spacing: mean of the field's path from the true curves

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

/// Mean distance of the carried contours from the true curves.
template <typename Carry>
double off_mm(const Truth& truth, Carry&& true_from_cad) {
  double sum_mm = 0.0;
  for (const Eigen::Vector3d& p : truth.nominal_mm)
    sum_mm += nearest_contour(truth.curves, true_from_cad(p)).foot.distance_mm;
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

/// One scan and what is known about it.
struct Sampled {
  const PosePart& part;
  Scan scan;
  PrepareOptions preparing;
  Truth truth;
  RigidMotion true_from_scan;

  [[nodiscard]] ScanModel model() const { return prepare_scan(scan, preparing).model; }
  [[nodiscard]] RigidMotion best_true_from_cad() const {
    return fit_rigid(truth.nominal_mm, truth.true_mm).to_from;
  }
  [[nodiscard]] double off_mm_by(const RigidMotion& scan_from_cad) const {
    return off_mm(truth, [&](const Eigen::Vector3d& p) { return true_from_scan * scan_from_cad * p; });
  }
};

/// What the whole job makes of the pose, where the rigid stage leaves much.
PoseVerdict verdict_by_field(const Sampled& scan, RegistrationOptions options) {
  options.method = RegistrationMethod::kSurface;
  ScanModel model = scan.model();
  const Registration found = register_part(scan.part.cad, model, options);
  if (!found.usable() || !found.refusals.empty()) return PoseVerdict::kRefused;
  const double path_off_mm = off_mm(scan.truth, [&](const Eigen::Vector3d& p) {
    return scan.true_from_scan * found.field->map(p).p_scan_mm;
  });
  return path_off_mm <= kOfField * model.spacing_mm ? PoseVerdict::kRight : PoseVerdict::kWrong;
}

PoseVerdict verdict_of(const Sampled& scan, const RigidMotion& scan_from_cad, double spacing_mm,
                       const PoseTrial& trial, const RegistrationOptions& options) {
  if (!same_side(scan.truth, scan.true_from_scan * scan_from_cad)) return PoseVerdict::kWrong;
  if (trial.off_mm <= trial.best_off_mm + kOfBest * spacing_mm) return PoseVerdict::kRight;
  return verdict_by_field(scan, options);
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
  Sampled known{part, {}, {}, truth_of(part), {}};
  known.scan.cloud = clean(sampled.cloud(), {}).cloud;
  known.preparing.threads = known.preparing.contour.threads = threads;
  known.true_from_scan = sampled.scan_from_cad.inverse() * Eigen::Translation3d(known.scan.cloud.offset_mm);
  ScanModel model = known.model();

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
  trial.off_mm = known.off_mm_by(found.rigid.scan_from_cad);
  trial.best_off_mm =
      off_mm(known.truth, [best = known.best_true_from_cad()](const Eigen::Vector3d& p) { return best * p; });
  trial.verdict = verdict_of(known, found.rigid.scan_from_cad, model.spacing_mm, trial, options);
  if (trial.verdict == PoseVerdict::kRefused) trial.reason = "the field refuses what the rigid stage leaves";
  return trial;
}

}  // namespace arris::bench
