#include "registration/segment_costs.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "fixtures/synthetic/random.hpp"
#include "registration/segment_solver.hpp"

namespace arris {
namespace {

using Steps = std::array<SegmentStep, 2>;

Eigen::Vector3d vector(synthetic::Random& random, double size) {
  return size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}
SegmentStep step(synthetic::Random& random, double turn_rad) {
  SegmentStep out;
  out << vector(random, turn_rad), vector(random, 2.0);
  return out;
}
Carrier carrier(synthetic::Random& random, int segment) {
  return {segment, random.uniform(0.2, 0.8), vector(random, 40.0)};
}

/// Central differences of order four: exact to about 1e-9 of the residual's size here.
Eigen::MatrixXd numeric(const std::function<Eigen::VectorXd(const Steps&)>& residual, const Steps& at,
                        std::size_t of) {
  const double h = 1e-3;
  Eigen::MatrixXd j(residual(at).size(), 6);
  for (int k = 0; k < 6; ++k) {
    const auto shifted = [&](double by) {
      Steps moved = at;
      moved[of][k] += by;
      return residual(moved);
    };
    j.col(k) = (8.0 * (shifted(h) - shifted(-h)) - (shifted(2.0 * h) - shifted(-2.0 * h))) / (12.0 * h);
  }
  return j;
}

/// Turns at which the closed forms and their series must agree with numeric differentiation.
const double kTurnsRad[] = {0.0, 1e-6, 1e-3, 0.05, 0.5};

TEST(SegmentCosts, CarriedPointsHaveTheJacobianOfTheirResidual) {
  synthetic::Random random(1);
  for (const double turn_rad : kTurnsRad)
    for (const int carriers : {1, 2}) {
      CarriedCost cost;
      cost.carriers = {carrier(random, 0), carrier(random, 1)};
      cost.carrier_count = carriers;
      cost.gap_mm = vector(random, 1.0);
      cost.directions << vector(random, 1.0).transpose(), vector(random, 1.0).transpose();
      const Steps at = {step(random, turn_rad), step(random, turn_rad)};
      for (std::size_t of = 0; of < static_cast<std::size_t>(carriers); ++of) {
        const Eigen::MatrixXd expected =
            numeric([&](const Steps& s) -> Eigen::VectorXd { return cost.residual(s); }, at, of);
        EXPECT_LT((cost.jacobian(at, of) - expected).cwiseAbs().maxCoeff(), 1e-6) << turn_rad;
      }
    }
}

TEST(SegmentCosts, SeamsHaveTheJacobianOfTheirResidual) {
  synthetic::Random random(2);
  for (const double turn_rad : kTurnsRad) {
    SeamCost cost;
    cost.sides = {carrier(random, 0), carrier(random, 1)};
    cost.rotations_scan_from_cad[0] = rotation_of(vector(random, 1.0));
    cost.rotations_scan_from_cad[1] = cost.rotations_scan_from_cad[0] * rotation_of(vector(random, 0.1));
    cost.gap_mm = vector(random, 1.0);
    cost.place_rows = rotation_of(vector(random, 1.0));
    cost.turn_rows = 3.0 * rotation_of(vector(random, 1.0));
    const Steps at = {step(random, turn_rad), step(random, turn_rad)};
    for (const std::size_t of : {0U, 1U}) {
      const Eigen::MatrixXd expected =
          numeric([&](const Steps& s) -> Eigen::VectorXd { return cost.residual(s); }, at, of);
      EXPECT_LT((cost.jacobian(at, of) - expected).cwiseAbs().maxCoeff(), 1e-6) << turn_rad << " " << of;
    }
  }
}

TEST(SegmentCosts, SeamOfOneMotionOnBothSidesCostsNothing) {
  synthetic::Random random(3);
  SeamCost cost;
  cost.sides[0] = cost.sides[1] = carrier(random, 0);
  const SegmentStep same = step(random, 0.3);
  EXPECT_LT(cost.residual({same, same}).norm(), 1e-12);
}

TEST(SegmentCosts, AnchorsHaveTheJacobianOfTheirResidual) {
  synthetic::Random random(4);
  AnchorCost cost;
  cost.offset_mm = vector(random, 3.0);
  cost.shift_rows = 0.2 * rotation_of(vector(random, 1.0));
  const Steps at = {step(random, 0.2), SegmentStep::Zero()};
  const Eigen::MatrixXd expected =
      numeric([&](const Steps& s) -> Eigen::VectorXd { return cost.residual(s[0]); }, at, 0);
  EXPECT_LT((cost.jacobian() - expected).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(SegmentCosts, GemanMcClureIsItsFormulaWithItsDerivatives) {
  const double c = 3.0, h = 1e-4;
  for (const double s : {0.0, 0.5, 4.0, 9.0, 100.0}) {
    const auto rho = [&](double x) { return c * c * x / (c * c + x); };
    EXPECT_NEAR(geman_mcclure(s, c)[0], rho(s), 1e-12);
    EXPECT_NEAR(geman_mcclure(s, c)[1], (rho(s + h) - rho(s - h)) / (2.0 * h), 1e-6);
    EXPECT_NEAR(geman_mcclure(s, c)[2], (geman_mcclure(s + h, c)[1] - geman_mcclure(s - h, c)[1]) / (2.0 * h),
                1e-6);
  }
}

/// One segment whose points a known step brings to their measured places.
SegmentProblem known_step(const SegmentStep& truth) {
  SegmentProblem problem;
  problem.segments = 1;
  AnchorCost anchor;
  anchor.shift_rows *= 1e-6;
  anchor.turn_sd_rad = 1e6;
  problem.anchors.push_back(anchor);
  synthetic::Random random(5);
  for (int i = 0; i < 30; ++i) {
    CarriedCost cost;
    cost.carriers[0].arm_mm = vector(random, 30.0);
    cost.gap_mm = -cost.carriers[0].moved_mm(truth);
    cost.rows = i % 2 + 1;
    cost.directions << vector(random, 1.0).transpose(), vector(random, 1.0).transpose();
    problem.edges.push_back(cost);
  }
  problem.edge_scale_sigmas = 1e3;
  return problem;
}

TEST(SolveSegments, FindsTheStepThatMadeTheData) {
  synthetic::Random random(6);
  const SegmentStep truth = step(random, 0.05);
  const SegmentSolution solution = solve_segments(known_step(truth), 50);
  ASSERT_TRUE(solution.statement.solved) << solution.statement.termination;
  EXPECT_EQ(solution.statement.termination, "converged");
  EXPECT_LT((solution.steps[0] - truth).norm(), 1e-6);
  EXPECT_LT(solution.statement.cost_after, 1e-9 * solution.statement.cost_before);
}

TEST(SolveSegments, SaysWhenItRanOutOfSteps) {
  synthetic::Random random(7);
  const SegmentSolution solution = solve_segments(known_step(step(random, 0.3)), 1);
  EXPECT_TRUE(solution.statement.solved);
  EXPECT_EQ(solution.statement.termination, "iteration limit");
  EXPECT_EQ(solution.statement.iterations, 1);
}

TEST(SolveSegments, NumbersThatAreNotFiniteAreAFailureInWordsAndMoveNothing) {
  synthetic::Random random(8);
  SegmentProblem problem = known_step(step(random, 0.05));
  problem.edges[3].gap_mm.x() = std::numeric_limits<double>::quiet_NaN();
  testing::internal::CaptureStderr();
  const SegmentSolution solution = solve_segments(problem, 50);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // nothing prints but the command line
  EXPECT_FALSE(solution.statement.solved);
  EXPECT_GT(solution.statement.termination.size(), 10U);
  EXPECT_EQ(solution.steps[0].norm(), 0.0);
}

}  // namespace
}  // namespace arris
