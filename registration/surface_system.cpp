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
  const Eigen::Index last = static_cast<Eigen::Index>(3 * nodes) + row.offset;
  gradient[last] += slope * row.offset_derivative;
  information(last, last) += curvature * row.offset_derivative * row.offset_derivative;
  for (std::size_t b = 0; b < node.size(); ++b)
    information.block<1, 3>(last, 3 * node[b]) +=
        curvature * row.offset_derivative * row.direction[b].transpose();
}

}  // namespace arris
