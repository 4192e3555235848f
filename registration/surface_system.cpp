#include "registration/surface_system.hpp"

namespace arris {

SurfaceSystem::SurfaceSystem(std::shared_ptr<const NodeBand> node_band, std::size_t offsets)
    : nodes(node_band->nodes()),
      band(std::move(node_band)),
      blocks(9 * band->pairs(), 0.0),
      border(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(offsets), static_cast<Eigen::Index>(3 * nodes))),
      corner(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(offsets))),
      gradient(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * nodes + offsets))) {}

void SurfaceSystem::add(const Row& row, double slope, double curvature) {
  const std::vector<std::int32_t>& node = *row.node;
  for (std::size_t a = 0; a < node.size(); ++a) {
    gradient.segment<3>(3 * node[a]) += slope * row.direction[a];
    const Eigen::Vector3d left = curvature * row.direction[a];
    for (std::size_t b = 0; b <= a; ++b)
      block(static_cast<std::size_t>(node[a]), static_cast<std::size_t>(node[b])).noalias() +=
          left * row.direction[b].transpose();
  }
  if (row.offset < 0) return;
  gradient[last(row)] += slope * row.offset_derivative;
  corner[row.offset] += curvature * row.offset_derivative * row.offset_derivative;
  for (std::size_t b = 0; b < node.size(); ++b)
    border.block<1, 3>(row.offset, 3 * node[b]) +=
        curvature * row.offset_derivative * row.direction[b].transpose();
}

void SurfaceSystem::add_along(const std::vector<std::int32_t>& node, const std::vector<double>& weight,
                              const Eigen::Vector3d& direction, double slope, double curvature) {
  const Eigen::Vector3d pull = slope * direction;
  const Eigen::Matrix3d square = curvature * direction * direction.transpose();
  for (std::size_t a = 0; a < node.size(); ++a) {
    gradient.segment<3>(3 * node[a]) += weight[a] * pull;
    const Eigen::Matrix3d left = weight[a] * square;
    for (std::size_t b = 0; b <= a; ++b)
      block(static_cast<std::size_t>(node[a]), static_cast<std::size_t>(node[b])) += weight[b] * left;
  }
}

void SurfaceSystem::add(const std::vector<std::int32_t>& node,
                        const std::vector<Eigen::Matrix<double, 3, kTogether>>& derivative,
                        const Residuals& slope, const Residuals& curvature) {
  for (std::size_t a = 0; a < node.size(); ++a) {
    gradient.segment<3>(3 * node[a]).noalias() += derivative[a] * slope;
    const Eigen::Matrix<double, 3, kTogether> left = derivative[a] * curvature.asDiagonal();
    for (std::size_t b = 0; b <= a; ++b)
      block(static_cast<std::size_t>(node[a]), static_cast<std::size_t>(node[b])).noalias() +=
          left * derivative[b].transpose();
  }
}

void SurfaceSystem::add_to_nodes(double curvature) {
  for (std::size_t a = 0; a < nodes; ++a) block(a, a).diagonal().array() += curvature;
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

Eigen::MatrixXd SurfaceSystem::dense() const {
  Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t b = band->first(a); b <= a; ++b)
      lower.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b)) = block(a, b);
  lower.bottomLeftCorner(border.rows(), border.cols()) = border;
  lower.diagonal().tail(corner.size()) = corner;
  return lower.selfadjointView<Eigen::Lower>();
}

SurfaceSystem& SurfaceSystem::operator+=(const SurfaceSystem& other) {
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] += other.blocks[i];
  border += other.border;
  corner += other.corner;
  gradient += other.gradient;
  return *this;
}

}  // namespace arris
