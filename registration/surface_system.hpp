#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace arris {

/// Normal equations over node shifts (3 each) and the contours' edge offsets: lower triangle, dense. Nodes
/// number a few hundred, so the blocked dense factorisation beats a sparse one.
struct SurfaceSystem {
  SurfaceSystem(std::size_t node_count, std::size_t offsets)
      : nodes(node_count),
        information(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * node_count + offsets),
                                          static_cast<Eigen::Index>(3 * node_count + offsets))),
        gradient(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * node_count + offsets))) {}

  /// Derivative of one residual: a direction for each node, and for one offset.
  struct Row {
    const std::vector<std::int32_t>* node = nullptr;
    std::vector<Eigen::Vector3d> direction;
    int offset = -1;
    double offset_derivative = 0.0;
  };
  /// Adds slope * J to the gradient and curvature * J'J to the information; for least squares slope = weight
  /// * residual, curvature = weight.
  void add(const Row& row, double slope, double curvature);
  /// Writes J' into a column of zeros.
  void put(const Row& row, Eigen::Ref<Eigen::VectorXd> column) const;
  /// J x, and M J' of a symmetric matrix; they cost the row's nodes, not all unknowns.
  [[nodiscard]] double dot(const Row& row, const Eigen::VectorXd& x) const;
  [[nodiscard]] Eigen::VectorXd times(const Eigen::MatrixXd& symmetric, const Row& row) const;
  SurfaceSystem& operator+=(const SurfaceSystem& other) {
    information += other.information;
    gradient += other.gradient;
    return *this;
  }

  [[nodiscard]] Eigen::Index last(const Row& row) const {
    return static_cast<Eigen::Index>(3 * nodes) + row.offset;
  }

  std::size_t nodes;
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

}  // namespace arris
