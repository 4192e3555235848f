#include "registration/segment_solver.hpp"

#include <ceres/ceres.h>

#include <algorithm>

namespace arris {
namespace {

using RowMajor66 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

std::array<SegmentStep, 2> steps_from(const double* const* parameters, int count) {
  std::array<SegmentStep, 2> steps = {SegmentStep::Zero(), SegmentStep::Zero()};
  for (int i = 0; i < count; ++i)
    steps[static_cast<std::size_t>(i)] = Eigen::Map<const SegmentStep>(parameters[i]);
  return steps;
}

/// kRows residuals of a carried point; kSizes: a 6 for each segment that carries it.
template <int kRows, int... kSizes>
class CarriedPoint final : public ceres::SizedCostFunction<kRows, kSizes...> {
 public:
  explicit CarriedPoint(const CarriedCost& cost) : cost_(cost) {}
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const std::array<SegmentStep, 2> steps = steps_from(parameters, sizeof...(kSizes));
    Eigen::Map<Eigen::Matrix<double, kRows, 1>> r(residuals);
    r = cost_.residual(steps).template head<kRows>();
    for (std::size_t i = 0; jacobians != nullptr && i < sizeof...(kSizes); ++i)
      if (jacobians[i] != nullptr)
        Eigen::Map<Eigen::Matrix<double, kRows, 6, Eigen::RowMajor>>{jacobians[i]} =
            cost_.jacobian(steps, i).template topRows<kRows>();
    return r.allFinite();
  }

 private:
  const CarriedCost& cost_;
};

class Seam final : public ceres::SizedCostFunction<6, 6, 6> {
 public:
  explicit Seam(const SeamCost& cost) : cost_(cost) {}
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const std::array<SegmentStep, 2> steps = steps_from(parameters, 2);
    Eigen::Map<SegmentStep> r(residuals);
    r = cost_.residual(steps);
    for (std::size_t i = 0; jacobians != nullptr && i < 2; ++i)
      if (jacobians[i] != nullptr) Eigen::Map<RowMajor66>{jacobians[i]} = cost_.jacobian(steps, i);
    return r.allFinite();
  }

 private:
  const SeamCost& cost_;
};

class Anchor final : public ceres::SizedCostFunction<6, 6> {
 public:
  explicit Anchor(const AnchorCost& cost) : cost_(cost) {}
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Map<SegmentStep> r(residuals);
    r = cost_.residual(Eigen::Map<const SegmentStep>(parameters[0]));
    if (jacobians != nullptr && jacobians[0] != nullptr)
      Eigen::Map<RowMajor66>{jacobians[0]} = cost_.jacobian();
    return r.allFinite();
  }

 private:
  const AnchorCost& cost_;
};

/// Ceres has no Geman-McClure.
class GemanMcClure final : public ceres::LossFunction {
 public:
  GemanMcClure(double scale_sigmas, double weight) : scale_sigmas_(scale_sigmas), weight_(weight) {}
  void Evaluate(double squared, double rho[3]) const override {
    const std::array<double, 3> loss = geman_mcclure(squared, scale_sigmas_);
    for (std::size_t i = 0; i < 3; ++i) rho[i] = weight_ * loss[i];
  }

 private:
  double scale_sigmas_, weight_;
};

void add_point(const CarriedCost& cost, double scale_sigmas, std::vector<SegmentStep>& steps,
               ceres::Problem& problem) {
  auto* loss = new GemanMcClure(scale_sigmas, cost.weight);  // the problem owns both
  double* first = steps[static_cast<std::size_t>(cost.carriers[0].segment)].data();
  double* second = steps[static_cast<std::size_t>(cost.carriers[1].segment)].data();
  if (cost.rows == 2 && cost.carrier_count == 2)
    problem.AddResidualBlock(new CarriedPoint<2, 6, 6>(cost), loss, first, second);
  else if (cost.rows == 2)
    problem.AddResidualBlock(new CarriedPoint<2, 6>(cost), loss, first);
  else if (cost.carrier_count == 2)
    problem.AddResidualBlock(new CarriedPoint<1, 6, 6>(cost), loss, first, second);
  else
    problem.AddResidualBlock(new CarriedPoint<1, 6>(cost), loss, first);
}

void fill(const SegmentProblem& parts, std::vector<SegmentStep>& steps, ceres::Problem& problem) {
  for (SegmentStep& step : steps) problem.AddParameterBlock(step.data(), 6);
  for (const AnchorCost& cost : parts.anchors)
    problem.AddResidualBlock(new Anchor(cost), nullptr, steps[static_cast<std::size_t>(cost.segment)].data());
  for (const CarriedCost& cost : parts.edges) add_point(cost, parts.edge_scale_sigmas, steps, problem);
  for (const CarriedCost& cost : parts.surface) add_point(cost, parts.surface_scale_sigmas, steps, problem);
  for (const SeamCost& cost : parts.seams)
    problem.AddResidualBlock(new Seam(cost), nullptr,
                             steps[static_cast<std::size_t>(cost.sides[0].segment)].data(),
                             steps[static_cast<std::size_t>(cost.sides[1].segment)].data());
}

/// Ceres would say so on stderr, whatever its options.
bool finite_at_start(const SegmentProblem& parts) {
  const std::array<SegmentStep, 2> still = {SegmentStep::Zero(), SegmentStep::Zero()};
  const auto finite = [&](const auto& cost) { return cost.residual(still).allFinite(); };
  return std::all_of(parts.edges.begin(), parts.edges.end(), finite) &&
         std::all_of(parts.surface.begin(), parts.surface.end(), finite) &&
         std::all_of(parts.seams.begin(), parts.seams.end(), finite) &&
         std::all_of(parts.anchors.begin(), parts.anchors.end(),
                     [](const AnchorCost& cost) { return cost.residual(SegmentStep::Zero()).allFinite(); });
}

SolverStatement statement_of(const ceres::Solver::Summary& summary) {
  SolverStatement statement;
  statement.solved = summary.IsSolutionUsable();
  statement.termination = summary.termination_type == ceres::CONVERGENCE      ? "converged"
                          : summary.termination_type == ceres::NO_CONVERGENCE ? "iteration limit"
                                                                              : summary.message;
  statement.iterations = static_cast<int>(summary.iterations.size()) - 1;  // the first entry is the start
  statement.cost_before = summary.initial_cost;
  statement.cost_after = summary.final_cost;
  return statement;
}

}  // namespace

SegmentSolution solve_segments(const SegmentProblem& problem, int max_iterations) {
  SegmentSolution solution;
  solution.steps.assign(problem.segments, SegmentStep::Zero());
  if (!finite_at_start(problem)) {
    solution.statement.termination = "a residual is not a finite number";
    return solution;
  }
  ceres::Problem sum;
  fill(problem, solution.steps, sum);
  ceres::Solver::Options options;
  options.num_threads = 1;  // sums in one order
  options.max_num_iterations = max_iterations;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type =
      ceres::EIGEN_SPARSE;  // others call a BLAS that may use threads
  options.logging_type = ceres::SILENT;
  options.max_solver_time_in_seconds = 1e9;  // a limit in seconds would make the result depend on the machine
  ceres::Solver::Summary summary;
  ceres::Solve(options, &sum, &summary);
  solution.statement = statement_of(summary);
  if (!solution.statement.solved) solution.steps.assign(problem.segments, SegmentStep::Zero());
  return solution;
}

}  // namespace arris
