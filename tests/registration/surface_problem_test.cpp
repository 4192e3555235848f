#include "registration/surface_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

/// Law: no step carries an edge out of the sight of its points. An edge that stands so far out in the void
/// that nothing there holds it comes back to its points and stays.
TEST(SurfaceProblem, EdgeFarOutInTheVoidComesBackInSmallSteps) {
  const synthetic::PlatePart part(synthetic::plate_with_circle(50.0));
  const CadModel cad = scenes::cad_of(part);
  const scenes::Trial trial = scenes::ideal_trial(part, {.points = 40000}, 2);
  SurfaceOptions options;
  options.band_mm = 30.0;
  SurfaceProblem problem(cad, trial.scan, RigidMotion::Identity(), options);
  problem.start_over();
  problem.take_points(1);
  problem.settle();
  const double there_mm = problem.fit.offset_mm.front();
  problem.fit.offset_mm.front() -= 0.45;
  const double far_mm = problem.fit.offset_mm.front();
  ASSERT_LT(problem.tau_mm, 0.05);
  problem.look();
  (void)problem.step();
  EXPECT_GT(problem.fit.offset_mm.front(), far_mm);
  EXPECT_LE(problem.fit.offset_mm.front(), far_mm + 5.01 * problem.tau_mm);
  problem.settle();
  EXPECT_EQ(problem.fit.stop, "converged");
  EXPECT_NEAR(problem.fit.offset_mm.front(), there_mm, 0.01);
}

}  // namespace
}  // namespace arris
