#include "registration/node_band.hpp"

#include <algorithm>

namespace arris {
namespace {

/// Appends the part of the cloud that is reached from `start`, nearest ring first; returns its last point.
std::size_t visit_from(std::size_t start, const std::vector<Eigen::Vector3d>& points_mm,
                       const std::vector<double>& reach_mm, std::vector<char>& visited,
                       std::vector<std::size_t>& order) {
  std::size_t next = order.size();
  order.push_back(start);
  visited[start] = 1;
  for (; next < order.size(); ++next)
    for (std::size_t j = 0; j < points_mm.size(); ++j) {
      if (visited[j] ||
          (points_mm[j] - points_mm[order[next]]).norm() >= 0.5 * (reach_mm[j] + reach_mm[order[next]]))
        continue;
      visited[j] = 1;
      order.push_back(j);
    }
  return order.back();
}

}  // namespace

NodeBand::NodeBand(std::vector<std::size_t> first) : first_(std::move(first)) {
  for (std::size_t a = 0; a < first_.size(); ++a) {
    start_.push_back(pairs_);
    pairs_ += a - first_[a] + 1;
  }
}

NodeBand NodeBand::full(std::size_t nodes) {
  return NodeBand(std::vector<std::size_t>(nodes, 0));
}

std::vector<std::size_t> numbered_along(const std::vector<Eigen::Vector3d>& points_mm,
                                        const std::vector<double>& reach_mm) {
  std::vector<std::size_t> order;
  std::vector<char> visited(points_mm.size(), 0);
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    if (visited[i]) continue;
    std::vector<char> seen = visited;  // a first visit ends at an outermost point
    std::vector<std::size_t> trial;
    const std::size_t outermost = visit_from(i, points_mm, reach_mm, seen, trial);
    visit_from(outermost, points_mm, reach_mm, visited, order);
  }
  return order;
}

NodeBand band_of(const std::vector<Eigen::Vector3d>& points_mm, const std::vector<double>& reach_mm) {
  std::vector<std::size_t> first;
  for (std::size_t a = 0; a < points_mm.size(); ++a) {
    std::size_t b = 0;
    while (b < a && (points_mm[b] - points_mm[a]).norm() >= reach_mm[a] + reach_mm[b]) ++b;
    first.push_back(b);
  }
  return NodeBand(std::move(first));
}

}  // namespace arris
