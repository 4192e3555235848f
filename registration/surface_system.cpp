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
  Eigen::MatrixXd whole = lower.selfadjointView<Eigen::Lower>();
  if (taken.cols() > 0) whole -= taken * taken.transpose();
  return whole;
}

void SurfaceSystem::add(const SurfaceSystem& other, double times) {
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] += times * other.blocks[i];
  border += times * other.border;
  corner += times * other.corner;
  gradient += times * other.gradient;
}

SurfaceSystem& SurfaceSystem::operator+=(const AlongSums& sums) {
  for (std::size_t i = 0; i < band->pairs(); ++i) {
    const double* six = &sums.six_[AlongSums::kSix * i];
    Eigen::Matrix3d square;
    square << six[0], six[1], six[2], six[1], six[3], six[4], six[2], six[4], six[5];
    Block(&blocks[9 * i]) += square;
  }
  gradient += sums.gradient_;
  return *this;
}

AlongSums::AlongSums(const NodeBand& band, std::size_t offsets)
    : band_(band),
      six_(kSix * band.pairs(), 0.0),
      gradient_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * band.nodes() + offsets))) {}

void AlongSums::add(const std::vector<std::int32_t>& node, const std::vector<double>& weight,
                    const Eigen::Vector3d& direction, double slope, double curvature) {
  const Eigen::Vector3d pull = slope * direction, bent = curvature * direction;
  const double square[kSix] = {bent.x() * direction.x(), bent.x() * direction.y(), bent.x() * direction.z(),
                               bent.y() * direction.y(), bent.y() * direction.z(), bent.z() * direction.z()};
  for (std::size_t a = 0; a < node.size(); ++a) {
    gradient_.segment<3>(3 * node[a]) += weight[a] * pull;
    double left[kSix];
    for (std::size_t k = 0; k < kSix; ++k) left[k] = weight[a] * square[k];
    const std::size_t first = band_.first(static_cast<std::size_t>(node[a]));
    double* row = &six_[kSix * band_.pair(static_cast<std::size_t>(node[a]), first)];
    for (std::size_t b = 0; b <= a; ++b) {
      double* here = row + kSix * (static_cast<std::size_t>(node[b]) - first);
      const double share = weight[b];
      for (std::size_t k = 0; k < kSix; ++k) here[k] += share * left[k];
    }
  }
}

}  // namespace arris
