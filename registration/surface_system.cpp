#include "registration/surface_system.hpp"

namespace arris {

void SurfaceSystem::add(const Row& row, double slope, double curvature) {
  const std::vector<std::int32_t>& node = *row.node;
  for (std::size_t a = 0; a < node.size(); ++a) {
    const Eigen::Index at = 3 * node[a];
    gradient.segment<3>(at) += slope * row.direction[a];
    const Eigen::Vector3d left = curvature * row.direction[a];
    for (std::size_t b = 0; b < node.size(); ++b)
      if (node[b] <= node[a])
        information.block<3, 3>(at, 3 * node[b]).noalias() += left * row.direction[b].transpose();
  }
  if (row.offset < 0) return;
  const Eigen::Index last = this->last(row);
  gradient[last] += slope * row.offset_derivative;
  information(last, last) += curvature * row.offset_derivative * row.offset_derivative;
  for (std::size_t b = 0; b < node.size(); ++b)
    information.block<1, 3>(last, 3 * node[b]) +=
        curvature * row.offset_derivative * row.direction[b].transpose();
}

double SurfaceSystem::dot(const Row& row, const Eigen::VectorXd& x) const {
  double sum = row.offset >= 0 ? row.offset_derivative * x[last(row)] : 0.0;
  for (std::size_t a = 0; a < row.node->size(); ++a)
    sum += row.direction[a].dot(x.segment<3>(3 * (*row.node)[a]));
  return sum;
}

void SurfaceSystem::put(const Row& row, Eigen::Ref<Eigen::VectorXd> column) const {
  for (std::size_t a = 0; a < row.node->size(); ++a) column.segment<3>(3 * (*row.node)[a]) = row.direction[a];
  if (row.offset >= 0) column[last(row)] = row.offset_derivative;
}

Eigen::VectorXd SurfaceSystem::times(const Eigen::MatrixXd& symmetric, const Row& row) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(gradient.size());
  for (std::size_t a = 0; a < row.node->size(); ++a)
    sum.noalias() += symmetric.middleCols<3>(3 * (*row.node)[a]) * row.direction[a];
  if (row.offset >= 0) sum += symmetric.col(last(row)) * row.offset_derivative;
  return sum;
}

}  // namespace arris
