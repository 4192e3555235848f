#include "registration/surface_factor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "acquisition/geometry/parallel_for.hpp"

namespace arris {
namespace {

constexpr std::size_t kTileNodes = 16;

}  // namespace

SurfaceFactor::SurfaceFactor(const SurfaceSystem& system) {
  fill(system);
  factorise();
  if (system.taken.cols() > 0 && usable_) take(system.taken);
}

void SurfaceFactor::fill(const SurfaceSystem& system) {
  const NodeBand& band = *system.band;
  for (std::size_t begin = 0; begin < system.nodes; begin += kTileNodes) {
    const std::size_t end = std::min(system.nodes, begin + kTileNodes);
    TileRow row;
    row.begin = static_cast<Eigen::Index>(3 * begin);
    row.size = static_cast<Eigen::Index>(3 * (end - begin));
    std::size_t first = begin;
    for (std::size_t a = begin; a < end; ++a) first = std::min(first, band.first(a));
    row.first = first / kTileNodes;
    for (std::size_t k = row.first; k < rows_.size(); ++k)
      row.tiles.push_back(Eigen::MatrixXd::Zero(row.size, rows_[k].size));
    row.tiles.push_back(Eigen::MatrixXd::Zero(row.size, row.size));
    for (std::size_t a = begin; a < end; ++a)
      for (std::size_t b = band.first(a); b <= a; ++b)
        row.tiles[b / kTileNodes - row.first].block<3, 3>(static_cast<Eigen::Index>(3 * (a - begin)),
                                                          static_cast<Eigen::Index>(3 * (b % kTileNodes))) =
            system.block(a, b);
    rows_.push_back(std::move(row));
  }
  if (system.corner.size() == 0) return;
  TileRow border;
  border.begin = static_cast<Eigen::Index>(3 * system.nodes);
  border.size = system.corner.size();
  for (const TileRow& row : rows_) border.tiles.push_back(system.border.middleCols(row.begin, row.size));
  border.tiles.push_back(system.corner.asDiagonal());
  rows_.push_back(std::move(border));
}

void SurfaceFactor::factorise() {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    TileRow& row = rows_[i];
    for (std::size_t j = row.first; j <= i; ++j) {
      Eigen::MatrixXd& here = row.tiles[j - row.first];
      for (std::size_t k = std::max(row.first, rows_[j].first); k < j; ++k)
        here.noalias() -= tile(i, k) * tile(j, k).transpose();
      if (j < i) {
        tile(j, j).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(here);
        continue;
      }
      const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> pivot(here);
      usable_ = usable_ && pivot.info() == Eigen::Success && here.allFinite();
    }
  }
}

/// (A - T T')^-1 = A^-1 + A^-1 T (1 - T' A^-1 T)^-1 T' A^-1; the determinants' ratio is that of 1 - T' A^-1
/// T.
void SurfaceFactor::take(const Eigen::MatrixXd& columns) {
  taken_ = columns;
  solve_lower_from(0, taken_);
  solve_upper_down_to(0, taken_);
  const Eigen::Index count = columns.cols();
  const Eigen::LLT<Eigen::MatrixXd> left(Eigen::MatrixXd::Identity(count, count) -
                                         columns.transpose() * taken_);
  usable_ = left.info() == Eigen::Success;
  log_taken_ = 2.0 * left.matrixLLT().diagonal().array().log().sum();
  left.matrixL().transpose().solveInPlace<Eigen::OnTheRight>(taken_);
}

void SurfaceFactor::solve_lower_from(std::size_t from, Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (std::size_t i = from; i < rows_.size(); ++i) {
    const TileRow& row = rows_[i];
    auto here = columns.middleRows(row.begin, row.size);
    for (std::size_t k = std::max(from, row.first); k < i; ++k)
      here.noalias() -= tile(i, k) * columns.middleRows(rows_[k].begin, rows_[k].size);
    tile(i, i).triangularView<Eigen::Lower>().solveInPlace(here);
  }
}

void SurfaceFactor::solve_upper_down_to(std::size_t to, Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (std::size_t i = rows_.size(); i-- > to;) {
    const TileRow& row = rows_[i];
    auto here = columns.middleRows(row.begin, row.size);
    tile(i, i).triangularView<Eigen::Lower>().transpose().solveInPlace(here);
    for (std::size_t k = std::max(to, row.first); k < i; ++k)
      columns.middleRows(rows_[k].begin, rows_[k].size).noalias() -= tile(i, k).transpose() * here;
  }
}

Eigen::MatrixXd SurfaceFactor::spread(Eigen::MatrixXd columns) const {
  if (columns.cols() == 0) return {};  // Eigen would take the address of what is not there
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  if (taken_.cols() > 0) {
    const Eigen::MatrixXd along = taken_.transpose() * columns;
    sum += along.transpose() * along;
  }
  solve_lower_from(0, columns);
  sum += columns.transpose() * columns;
  return sum;
}

Eigen::VectorXd SurfaceFactor::solve(const Eigen::VectorXd& right) const {
  Eigen::MatrixXd column = right;
  solve_lower_from(0, column);
  solve_upper_down_to(0, column);
  if (taken_.cols() > 0) column += taken_ * (taken_.transpose() * right);
  return column;
}

double SurfaceFactor::log_determinant() const {
  double sum = log_taken_;
  for (const TileRow& row : rows_) sum += 2.0 * row.tiles.back().diagonal().array().log().sum();
  return sum;
}

Eigen::MatrixXd SurfaceFactor::inverse(int threads) const {
  const Eigen::Index n = rows_.empty() ? 0 : rows_.back().begin + rows_.back().size;
  Eigen::MatrixXd lower = Eigen::MatrixXd::Identity(n, n);
  parallel_for(rows_.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      auto columns = lower.middleCols(rows_[j].begin, rows_[j].size);
      solve_lower_from(j, columns);
      solve_upper_down_to(j, columns);
    }
  });
  Eigen::MatrixXd whole = lower.selfadjointView<Eigen::Lower>();
  if (taken_.cols() > 0) whole += taken_ * taken_.transpose();
  return whole;
}

}  // namespace arris
