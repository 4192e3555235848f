#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "acquisition/types/frames.hpp"

namespace arris {

/// Gauss-Newton normal equations of one rigid motion, rotation (rad) before translation (mm), for a left
/// perturbation x -> exp(omega) (x - pivot) + pivot + v about a pivot near the data, which keeps the 6x6
/// conditioned.
struct NormalEquations {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  double cost = 0.0;    ///< sum of weight * residual^2
  double weight = 0.0;  ///< sum of weights

  /// Adds weight * (direction . (x + motion - target))^2, with residual = direction . (x - target) now.
  void add(const Eigen::Vector3d& x_from_pivot_mm, const Eigen::Vector3d& direction, double residual_mm,
           double weight_of_residual) {
    Eigen::Matrix<double, 6, 1> row;
    row << x_from_pivot_mm.cross(direction), direction;
    information.noalias() += weight_of_residual * row * row.transpose();
    gradient += weight_of_residual * residual_mm * row;
    cost += weight_of_residual * residual_mm * residual_mm;
    weight += weight_of_residual;
  }
  NormalEquations& operator+=(const NormalEquations& other) {
    information += other.information;
    gradient += other.gradient;
    cost += other.cost;
    weight += other.weight;
    return *this;
  }
  /// The step that minimises cost + prior: prior_ is added to the diagonal (1/rad^2 three times, 1/mm^2 three
  /// times).
  [[nodiscard]] Eigen::Matrix<double, 6, 1> solve(const Eigen::Matrix<double, 6, 1>& prior) const {
    Eigen::Matrix<double, 6, 6> damped = information;
    damped.diagonal() += prior;
    return -damped.ldlt().solve(gradient);
  }
};

/// The rigid motion of a step about a pivot.
[[nodiscard]] inline RigidMotion motion_of(const Eigen::Matrix<double, 6, 1>& step,
                                           const Eigen::Vector3d& pivot_mm) {
  const Eigen::Vector3d omega = step.head<3>();
  const double angle_rad = omega.norm();
  RigidMotion motion = RigidMotion::Identity();
  if (angle_rad > 0.0) motion.linear() = Eigen::AngleAxisd(angle_rad, omega / angle_rad).toRotationMatrix();
  motion.translation() = pivot_mm - motion.linear() * pivot_mm + step.tail<3>();
  return motion;
}

/// Geman-McClure weight at residual r for scale c: (c^2 / (c^2 + r^2))^2, the derivative of c^2 r^2 / (c^2 +
/// r^2). Annealing c from large to small is graduated non-convexity (Yang et al., RA-L 5(2), 2020).
[[nodiscard]] inline double geman_mcclure_weight(double residual2, double scale) {
  const double c2 = scale * scale;
  const double ratio = c2 / (c2 + residual2);
  return ratio * ratio;
}

}  // namespace arris
