#pragma once

#include <Eigen/Core>
#include <vector>

#include "registration/surface_system.hpp"

namespace arris {

/// Cholesky factor of a surface system's information, in dense tiles of its band: O(nodes * band^2), where
/// all nodes at once would cost O(nodes^3). What is taken from the system is a matter of a few columns
/// (Woodbury).
class SurfaceFactor {
 public:
  explicit SurfaceFactor(const SurfaceSystem& system);
  /// Not positive definite, or not finite: no result may be used.
  [[nodiscard]] bool usable() const { return usable_; }
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  [[nodiscard]] double log_determinant() const;
  /// columns' inverse columns, of the information.
  [[nodiscard]] Eigen::MatrixXd spread(Eigen::MatrixXd columns) const;
  /// Of the information; both triangles. O(n^2 * band); the same bytes for any number of threads.
  [[nodiscard]] Eigen::MatrixXd inverse(int threads) const;

 private:
  struct TileRow {
    Eigen::Index begin = 0, size = 0;    // of the unknowns
    std::size_t first = 0;               // tile of the first column
    std::vector<Eigen::MatrixXd> tiles;  // of columns first .. its own
  };
  void fill(const SurfaceSystem& system);
  void factorise();
  void take(const Eigen::MatrixXd& columns);
  [[nodiscard]] const Eigen::MatrixXd& tile(std::size_t i, std::size_t k) const {
    return rows_[i].tiles[k - rows_[i].first];
  }
  /// In place, rows of tiles `from` on; those above are zero (lower) or not asked for (upper).
  void solve_lower_from(std::size_t from, Eigen::Ref<Eigen::MatrixXd> columns) const;
  void solve_upper_down_to(std::size_t to, Eigen::Ref<Eigen::MatrixXd> columns) const;

  std::vector<TileRow> rows_;
  Eigen::MatrixXd taken_;   // columns t: the inverse is that of the tiles plus t t'
  double log_taken_ = 0.0;  // of the determinant
  bool usable_ = true;
};

}  // namespace arris
