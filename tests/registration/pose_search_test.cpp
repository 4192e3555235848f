#include "registration/pose_search.hpp"

#include <gtest/gtest.h>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// A table, a clamp across the rim, lumps, a border of the view, gaps and strays.
synthetic::ScanOptions all_of_it() {
  synthetic::ScanOptions options;
  options.clutter = true;
  options.around = {30.0, 1, 3, 0.06};
  options.missing_ratio = 0.05, options.stray_ratio = 0.02, options.wall_ratio = 0.05;
  return options;
}

TEST(PoseSearch, ClutterDoesNotPullAPoseAwayFromWhereItFits) {
  const synthetic::FePart part = scenes::fe("sheet");
  const CadModel cad = scenes::cad_of(part);
  const PoseSearch search(cad, 60.0, 1);
  for (const std::uint64_t seed : {110057U, 3U}) {
    const scenes::Trial trial = scenes::trial_of(part, all_of_it(), seed);
    const LightScan scan(trial.scan, false, false);
    const PoseCandidate found = search.refine(scan, trial.scan_from_cad);
    ASSERT_TRUE(found.usable());
    EXPECT_LE(found.misfit.patient_mm, search.score().of(scan, trial.scan_from_cad).patient_mm + 1e-9);
    EXPECT_LT((found.scan_from_cad * cad.contours[0].point_mm(0.0) -
               trial.scan_from_cad * cad.contours[0].point_mm(0.0))
                  .norm(),
              3.0 * trial.scan.spacing_mm);
  }
}

TEST(PoseSearch, TheBoundOfAStartIsNoMoreThanItsScore) {
  const synthetic::FePart part = scenes::fe("bracket");
  const CadModel cad = scenes::cad_of(part, {0, 1, 2, 3});
  const PoseScore score(cad, 60.0);
  const scenes::Trial trial = scenes::trial_of(part, {}, 5);
  const LightScan scan(trial.scan, false, false);
  synthetic::Random random(6);
  for (int i = 0; i < 200; ++i) {
    const RigidMotion start = scenes::disturbance(random, {0, 0, 0}, 0.02 * i, 0.5 * i) * trial.scan_from_cad;
    EXPECT_LE(score.least_of_start_mm(scan, start), score.of_start(scan, start).patient_mm + 1e-12);
  }
}

}  // namespace
}  // namespace arris
