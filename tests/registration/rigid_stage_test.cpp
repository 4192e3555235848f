#include "registration/rigid_stage.hpp"

#include <gtest/gtest.h>

#include "registration/found_edge.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// Share of the edge that is seen from the rigid motion of a bent part.
double seen_from_rigid(std::int64_t points, double noise_sigma_mm) {
  const synthetic::FePart part = scenes::fe("porthole");
  synthetic::ScanOptions scan;
  scan.points = points;
  scan.noise_sigma_mm = noise_sigma_mm;
  scenes::Trial trial = scenes::trial_of(part, scan, 3);
  RegistrationOptions options;
  options.method = RegistrationMethod::kRigid;
  const CadModel cad = scenes::cad_of(part);
  const Registration found = register_part(cad, trial.scan, options);
  EXPECT_TRUE(found.usable());
  return seen_ratio(found.contours);
}

TEST(RigidStage, MorePointsAndLessNoiseShowNoLessOfABentEdge) {
  EXPECT_GT(seen_from_rigid(1500, 0.05), 0.9);
  EXPECT_GT(seen_from_rigid(60000, 0.05), 0.95);
  EXPECT_GT(seen_from_rigid(60000, 0.0), 0.95);
}

}  // namespace
}  // namespace arris
