#include "registration/normal_equations.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "fixtures/synthetic/random.hpp"

namespace arris {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Row {
  Eigen::Vector3d x_mm, target_mm, direction;
  double weight;
};

std::vector<Row> random_rows(std::uint64_t seed) {
  synthetic::Random random(seed);
  std::vector<Row> rows;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d x = 100.0 * random.direction();
    rows.push_back({x, x + 2.0 * random.direction(), random.direction(), random.uniform(0.1, 2.0)});
  }
  return rows;
}

double residual_mm(const Row& row, const Vector6& step, const Eigen::Vector3d& pivot_mm) {
  return row.direction.dot(motion_of(step, pivot_mm) * row.x_mm - row.target_mm);
}

NormalEquations equations(const std::vector<Row>& rows, const Eigen::Vector3d& pivot_mm) {
  NormalEquations sum;
  for (const Row& row : rows)
    sum.add(row.x_mm - pivot_mm, row.direction, residual_mm(row, Vector6::Zero(), pivot_mm), row.weight);
  return sum;
}

TEST(NormalEquations, GradientAndInformationAgreeWithFiniteDifferences) {
  const Eigen::Vector3d pivot_mm(5.0, -3.0, 20.0);
  const std::vector<Row> rows = random_rows(4);
  const NormalEquations sum = equations(rows, pivot_mm);
  Vector6 gradient = Vector6::Zero();
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  double cost = 0.0, weight = 0.0;
  for (const Row& row : rows) {
    Vector6 slope;
    for (int k = 0; k < 6; ++k) {
      const double h = k < 3 ? 1e-6 : 1e-4;
      slope[k] = (residual_mm(row, h * Vector6::Unit(k), pivot_mm) -
                  residual_mm(row, -h * Vector6::Unit(k), pivot_mm)) /
                 (2.0 * h);
    }
    const double r = residual_mm(row, Vector6::Zero(), pivot_mm);
    gradient += row.weight * r * slope;
    information += row.weight * slope * slope.transpose();
    cost += row.weight * r * r;
    weight += row.weight;
  }
  EXPECT_LT((sum.gradient - gradient).norm(), 1e-6 * gradient.norm());
  EXPECT_LT((sum.information - information).norm(), 1e-6 * information.norm());
  EXPECT_NEAR(sum.cost, cost, 1e-10 * cost);
  EXPECT_NEAR(sum.weight, weight, 1e-12);
}

TEST(NormalEquations, AddingTwoHalvesIsAddingAll) {
  const std::vector<Row> rows = random_rows(6);
  const Eigen::Vector3d pivot_mm = Eigen::Vector3d::Zero();
  NormalEquations halves = equations({rows.begin(), rows.begin() + 20}, pivot_mm);
  halves += equations({rows.begin() + 20, rows.end()}, pivot_mm);
  const NormalEquations all = equations(rows, pivot_mm);
  EXPECT_LT((halves.information - all.information).norm(), 1e-12 * all.information.norm());
  EXPECT_LT((halves.gradient - all.gradient).norm(), 1e-12 * all.gradient.norm());
}

TEST(NormalEquations, SolutionIsTheMinimumOfTheLinearCostWithItsPrior) {
  const NormalEquations sum = equations(random_rows(9), Eigen::Vector3d::Zero());
  Vector6 prior;
  prior << 1e4, 2e4, 3e4, 1.0, 2.0, 3.0;
  const Vector6 step = sum.solve(prior);
  const auto cost = [&](const Vector6& d) {
    return sum.cost + 2.0 * sum.gradient.dot(d) + d.dot(sum.information * d) + d.dot(prior.cwiseProduct(d));
  };
  for (int k = 0; k < 6; ++k)
    for (const double h : {-1e-4, 1e-4}) EXPECT_GT(cost(step + h * Vector6::Unit(k)), cost(step));
}

TEST(MotionOf, TurnsAboutThePivotAndStaysRigid) {
  synthetic::Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d pivot_mm = 1000.0 * random.direction();
    Vector6 step;
    step << random.uniform(0.0, 3.0) * random.direction(), 5.0 * random.direction();
    const RigidMotion motion = motion_of(step, pivot_mm);
    EXPECT_LT((motion.linear() * motion.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(motion.linear().determinant(), 1.0, 1e-14);
    EXPECT_LT((motion * pivot_mm - pivot_mm - step.tail<3>()).norm(), 1e-10);
    EXPECT_LT((motion.linear() * step.head<3>() - step.head<3>()).norm(), 1e-13);  // the axis stays
  }
  EXPECT_TRUE(motion_of(Vector6::Zero(), {1, 2, 3}).matrix().isIdentity(0.0));
}

TEST(GemanMcClure, WeightIsTheDerivativeOfRho) {
  for (const double scale : {0.1, 1.0, 20.0}) {
    const auto rho = [&](double r2) { return scale * scale * r2 / (scale * scale + r2); };
    for (const double r : {0.0, 0.05, 0.5, 3.0, 40.0}) {
      const double r2 = r * r, h = 1e-4 * (r2 + scale * scale);
      EXPECT_NEAR(geman_mcclure_weight(r2, scale), (rho(r2 + h) - rho(r2 - h)) / (2.0 * h), 1e-6);
    }
    EXPECT_EQ(geman_mcclure_weight(0.0, scale), 1.0);
    EXPECT_NEAR(geman_mcclure_weight(scale * scale, scale), 0.25, 1e-15);
  }
}

}  // namespace
}  // namespace arris
