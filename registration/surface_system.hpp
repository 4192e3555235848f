#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "registration/node_band.hpp"

namespace arris {

/// Normal equations over node shifts (3 each) and the contours' edge offsets: the lower triangle, 3x3 blocks
/// of the band of nodes, below them a row for each offset.
struct SurfaceSystem {
  SurfaceSystem(std::shared_ptr<const NodeBand> node_band, std::size_t offsets);

  /// Derivative of one residual: a direction for each node, and for one offset.
  struct Row {
    const std::vector<std::int32_t>* node = nullptr;  ///< ascending
    std::vector<Eigen::Vector3d> direction;
    int offset = -1;
    double offset_derivative = 0.0;
  };
  /// Adds slope * J to the gradient and curvature * J'J to the information; for least squares slope = weight
  /// * residual, curvature = weight.
  void add(const Row& row, double slope, double curvature);
  /// The same for several residuals of the same nodes at once: derivatives of node k are column k's (3 x 6).
  static constexpr int kTogether = 6;
  using Residuals = Eigen::Matrix<double, kTogether, 1>;
  void add(const std::vector<std::int32_t>& node,
           const std::vector<Eigen::Matrix<double, 3, kTogether>>& derivative, const Residuals& slope,
           const Residuals& curvature);
  /// Adds a curvature to all unknowns of the nodes, or of one offset.
  void add_to_nodes(double curvature);
  void add_to_offset(std::size_t offset, double curvature) {
    corner[static_cast<Eigen::Index>(offset)] += curvature;
  }
  /// Writes J' into a column of zeros.
  void put(const Row& row, Eigen::Ref<Eigen::VectorXd> column) const;
  /// J x, and M J' of a symmetric matrix; they cost the row's nodes, not all unknowns.
  [[nodiscard]] double dot(const Row& row, const Eigen::VectorXd& x) const;
  [[nodiscard]] Eigen::VectorXd times(const Eigen::MatrixXd& symmetric, const Row& row) const;
  /// The whole information, both triangles, less what is taken.
  [[nodiscard]] Eigen::MatrixXd dense() const;
  /// Adds a system from which nothing is taken, as if all of its residuals weighed so many times as much.
  void add(const SurfaceSystem& other, double times);
  SurfaceSystem& operator+=(const SurfaceSystem& other) {
    add(other, 1.0);
    return *this;
  }
  SurfaceSystem& operator+=(const class AlongSums& sums);

  using Block = Eigen::Map<Eigen::Matrix3d>;
  using ConstBlock = Eigen::Map<const Eigen::Matrix3d>;
  [[nodiscard]] Block block(std::size_t a, std::size_t b) { return Block(&blocks[9 * band->pair(a, b)]); }
  [[nodiscard]] ConstBlock block(std::size_t a, std::size_t b) const {
    return ConstBlock(&blocks[9 * band->pair(a, b)]);
  }
  [[nodiscard]] Eigen::Index last(const Row& row) const {
    return static_cast<Eigen::Index>(3 * nodes) + row.offset;
  }

  std::size_t nodes;
  std::shared_ptr<const NodeBand> band;
  std::vector<double> blocks;  ///< 3x3 each, of the band's pairs
  Eigen::MatrixXd border;      ///< offsets x 3 nodes
  Eigen::VectorXd corner;      ///< of the offsets, which share no residual
  Eigen::VectorXd gradient;
  /// Columns that are no unknowns any more took this times its transpose from the information above.
  Eigen::MatrixXd taken;
};

/// Sums of many rows whose directions are weight[k] * direction, all of one direction: their blocks are
/// symmetric, six numbers instead of nine. This is the hot loop of a dense scan's fit.
class AlongSums {
 public:
  AlongSums(const NodeBand& band, std::size_t offsets);
  /// node: ascending; slope and curvature as SurfaceSystem::add() takes them.
  void add(const std::vector<std::int32_t>& node, const std::vector<double>& weight,
           const Eigen::Vector3d& direction, double slope, double curvature);

 private:
  friend struct SurfaceSystem;
  static constexpr std::size_t kSix = 6;  // 00 01 02 11 12 22
  const NodeBand& band_;
  std::vector<double> six_;  // of each pair
  Eigen::VectorXd gradient_;
};

}  // namespace arris
