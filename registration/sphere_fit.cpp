#include "registration/sphere_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/median.hpp"

namespace arris {
namespace {

constexpr double kStartGateRatio = 0.1, kLeastGateRatio = 1e-4, kGateSigmas = 4.0;
constexpr double kMadToSigma = 1.4826;
constexpr int kShrinkingRounds = 15, kMostRounds = 30;
constexpr double kLeastSpread = 0.04;      // a cap of 24 degrees
constexpr double kCylinderMargin = 2.0;    // over what a band of a cylinder shows within the gate
constexpr double kMostInsideRatio = 0.05;  // of the points on the sphere
constexpr double kRadiusSigmas = 4.0;

/// The points within the gate, with sums of the linearised fit.
struct Shell {
  std::vector<std::int32_t> points;
  std::vector<double> off_mm;  // signed distance from the sphere, outside positive
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moments_mm = Eigen::Vector3d::Zero();
  std::size_t inside = 0;  // points well inside the sphere
};

Shell shell_of(std::span<const Eigen::Vector3d> points_mm, const std::vector<std::int32_t>& candidates,
               const Eigen::Vector3d& centre_mm, double radius_mm, double gate_mm) {
  Shell shell;
  for (const std::int32_t i : candidates) {
    const Eigen::Vector3d out_mm = points_mm[static_cast<std::size_t>(i)] - centre_mm;
    const double off_mm = out_mm.norm() - radius_mm;
    if (off_mm < -std::max(gate_mm, kStartGateRatio * radius_mm)) ++shell.inside;
    if (std::abs(off_mm) > gate_mm) continue;
    const Eigen::Vector3d u = out_mm.normalized();
    shell.points.push_back(i);
    shell.off_mm.push_back(off_mm);
    shell.squares += u * u.transpose();
    shell.moments_mm += off_mm * u;
  }
  return shell;
}

double robust_sigma_mm(std::vector<double> off_mm) {
  for (double& value : off_mm) value = std::abs(value);
  return kMadToSigma * median_of(std::move(off_mm));
}

/// Radius that the points have of their own, and its standard deviation for noise of `sigma_mm`: one
/// Gauss-Newton step from the known radius, exact enough for a decision.
struct OwnRadius {
  double radius_mm = 0.0, sd_mm = 0.0;
};
OwnRadius own_radius(const Shell& shell, std::span<const Eigen::Vector3d> points_mm,
                     const Eigen::Vector3d& centre_mm, double radius_mm, double sigma_mm) {
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d moments = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < shell.points.size(); ++k) {
    Eigen::Vector4d row;
    row << (points_mm[static_cast<std::size_t>(shell.points[k])] - centre_mm).normalized(), 1.0;
    squares += row * row.transpose();
    moments += shell.off_mm[k] * row;
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(squares);
  const Eigen::Vector4d step = solver.solve(moments), radius_column = solver.solve(Eigen::Vector4d::UnitW());
  return {radius_mm + step(3), sigma_mm * std::sqrt(std::max(0.0, radius_column(3)))};
}

bool holds(const Shell& shell, double radius_mm, double gate_mm, const SphereOptions& options) {
  const std::size_t count = shell.points.size();
  if (count < static_cast<std::size_t>(options.fewest_points)) return false;
  // a cylinder of the same radius shows a band as wide as the gate lets it: sqrt(2 r g) each way
  const double band = 2.0 * gate_mm / (3.0 * radius_mm);
  if (least_spread(shell.squares, count) < std::max(kLeastSpread, kCylinderMargin * band)) return false;
  return static_cast<double>(shell.inside) <= kMostInsideRatio * static_cast<double>(count);
}

}  // namespace

double least_spread(const Eigen::Matrix3d& sum_of_squares, std::size_t count) {
  if (count == 0) return 0.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum_of_squares, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0) / static_cast<double>(count);
}

std::optional<FoundSphere> fit_sphere(std::span<const Eigen::Vector3d> points_mm,
                                      const std::vector<std::int32_t>& candidates,
                                      const Eigen::Vector3d& start_mm, double radius_mm,
                                      const SphereOptions& options) {
  FoundSphere found;
  found.centre_mm = start_mm;
  double gate_mm = kStartGateRatio * radius_mm;
  Shell shell;
  for (int round = 0; round < kMostRounds; ++round) {
    shell = shell_of(points_mm, candidates, found.centre_mm, radius_mm, gate_mm);
    if (shell.points.size() < static_cast<std::size_t>(options.fewest_points) ||
        least_spread(shell.squares, shell.points.size()) < kLeastSpread)
      return std::nullopt;
    found.centre_mm += shell.squares.ldlt().solve(shell.moments_mm);
    if (round < kShrinkingRounds)
      gate_mm =
          std::max({0.5 * gate_mm, kGateSigmas * robust_sigma_mm(shell.off_mm), kLeastGateRatio * radius_mm});
  }
  shell = shell_of(points_mm, candidates, found.centre_mm, radius_mm, gate_mm);
  if (!holds(shell, radius_mm, gate_mm, options)) return std::nullopt;
  double squares_mm2 = 0.0;
  for (const double off_mm : shell.off_mm) squares_mm2 += off_mm * off_mm;
  found.noise_sigma_mm = std::sqrt(squares_mm2 / static_cast<double>(shell.points.size() - 3));
  if (found.noise_sigma_mm > options.noise_most_ratio * radius_mm) return std::nullopt;
  const OwnRadius own = own_radius(shell, points_mm, found.centre_mm, radius_mm, found.noise_sigma_mm);
  found.own_radius_mm = own.radius_mm;
  if (!(std::abs(own.radius_mm - radius_mm) <=
        kRadiusSigmas * own.sd_mm + options.radius_tolerance_ratio * radius_mm))
    return std::nullopt;
  found.covariance_mm2 = found.noise_sigma_mm * found.noise_sigma_mm * shell.squares.inverse();
  found.points = std::move(shell.points);
  return found;
}

}  // namespace arris
