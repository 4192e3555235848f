#include "registration/pose_watch.hpp"

#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;

/// The first hole is followed.
const PlatePart& six_holes() {
  static const PlatePart part(synthetic::plate_with_six_holes());
  return part;
}

const CadModel& six_holes_cad() {
  static const CadModel cad = scenes::cad_of(six_holes());
  return cad;
}

/// Patches of the followed rim are missing, and strays stand beside it: extracted edge points wander from it
/// by ten millimetres and more, while the other holes are seen well.
synthetic::ScanOptions ragged() {
  synthetic::ScanOptions options;
  options.band_mm = 0.0;
  options.missing_ratio = 0.12, options.stray_ratio = 0.03;
  return options;
}

double carried_off_mm(const scenes::Trial& trial, const DeformationField& field) {
  const auto carry = [&](double, const Eigen::Vector3d& p) { return field.map(p).p_scan_mm; };
  return scenes::distance_between(scenes::carried(six_holes_cad().contours[0], 3.0, carry),
                                  trial.true_curve_mm)
      .mean_mm;
}

Registration registered(scenes::Trial& trial, RegistrationMethod method) {
  RegistrationOptions options;
  options.method = method;
  return register_part(six_holes_cad(), trial.scan, options);
}

TEST(PoseWatch, APoseFitsAsWellAsItselfAndWorseTheFartherItIsMoved) {
  const scenes::Trial trial = scenes::trial_of(six_holes(), ragged(), 57);
  const CoarseAlignment found = coarse_align(six_holes_cad(), trial.scan, {});
  ASSERT_TRUE(found.usable()) << found.reason;
  const PoseWatch watch(six_holes_cad(), trial.scan, 60.0, found.score_mm);
  const auto moved_by = [&](double mm) {
    return RigidMotion(found.scan_from_cad * Eigen::Translation3d(mm, 0.0, 0.0));
  };
  EXPECT_LE(watch.times_worse(moved_by(0.0)), 1.0 + 1e-9);
  EXPECT_GT(watch.times_worse(moved_by(8.0)), kAstrayRatio);
  EXPECT_GT(watch.times_worse(moved_by(-8.0)), kAstrayRatio);
}

/// The extracted points of these pulled the rigid fit up to 6 mm away from a pose that was found well.
TEST(RigidStage, EndsNowhereThatTheWholeScanBelies) {
  for (const std::uint64_t seed : {600120U, 12015U, 10377U, 20016U}) {
    scenes::Trial trial = scenes::trial_of(six_holes(), ragged(), seed);
    const ScanModel before = scenes::trial_of(six_holes(), ragged(), seed).scan;
    const Registration found = registered(trial, RegistrationMethod::kRigid);
    ASSERT_TRUE(found.usable()) << seed;
    const PoseWatch watch(six_holes_cad(), before, 60.0, found.coarse.score_mm);
    EXPECT_LE(watch.times_worse(found.rigid.scan_from_cad), kAstrayRatio) << seed;
    EXPECT_LT(carried_off_mm(trial, *found.field), 0.5 * before.spacing_mm) << seed;
  }
}

/// Those of the test before; and scans whose field was pulled away from a right rigid pose.
TEST(RegisterPart, WhereStraysStandInGapsAPathIsRightOrRefused) {
  int accepted = 0;
  for (const std::uint64_t seed : {600120U, 12015U, 20016U, 31104U, 31419U, 600246U}) {
    scenes::Trial trial = scenes::trial_of(six_holes(), ragged(), seed);
    const Registration found = registered(trial, RegistrationMethod::kSurface);
    if (!found.usable() || !found.refusals.empty()) continue;
    ++accepted;
    EXPECT_LT(carried_off_mm(trial, *found.field), 0.25 * trial.scan.spacing_mm) << seed;
  }
  EXPECT_GE(accepted, 3);
}

/// Extracted points of a ragged rim leave too much at a right pose; the edge by support, and the holes that
/// took no part in the fit, do not.
TEST(CoarseAlign, ARaggedRimHidesNoPoseThatTheRestOfTheScanConfirms) {
  for (const std::uint64_t seed : {20079U, 700164U, 300177U}) {
    const scenes::Trial trial = scenes::trial_of(six_holes(), ragged(), seed);
    const CoarseAlignment found = coarse_align(six_holes_cad(), trial.scan, {});
    ASSERT_TRUE(found.usable()) << seed << ": " << found.reason;
    EXPECT_LT(carried_off_mm(trial, RigidField(found.scan_from_cad)), trial.scan.spacing_mm) << seed;
  }
}

TEST(CoarseAlign, ARaggedRimLetsNoMirroredScanPass) {
  for (const std::uint64_t seed : {20079U, 700164U, 300177U, 600246U}) {
    const scenes::Trial trial =
        scenes::changed_trial(six_holes(), ragged(), seed, [](Eigen::Vector3f& p, Eigen::Vector3f& n) {
          p.x() = -p.x();
          n.x() = -n.x();
        });
    EXPECT_FALSE(coarse_align(six_holes_cad(), trial.scan, {}).usable()) << seed;
  }
}

}  // namespace
}  // namespace arris
