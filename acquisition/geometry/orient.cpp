#include "acquisition/geometry/orient.hpp"

#include <queue>
#include <tuple>

namespace arris {

void orient_consistently(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree, int k,
                         std::vector<Eigen::Vector3d>& normals) {
  using Step = std::tuple<double, std::size_t, std::size_t>;  // cost, to, from
  std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
  std::vector<char> done(points_mm.size(), 0);
  std::vector<Neighbour> near;
  const auto visit = [&](std::size_t i) {
    done[i] = 1;
    tree.nearest_k(points_mm[i], k, near);
    for (const Neighbour& neighbour : near) {
      const std::size_t j = static_cast<std::size_t>(neighbour.index);
      if (!done[j]) front.emplace(1.0 - std::abs(normals[i].dot(normals[j])), j, i);
    }
  };
  for (std::size_t seed = 0; seed < points_mm.size(); ++seed) {
    if (done[seed]) continue;
    visit(seed);
    while (!front.empty()) {
      const auto [cost, to, from] = front.top();
      front.pop();
      if (done[to]) continue;
      if (normals[to].dot(normals[from]) < 0.0) normals[to] = -normals[to];
      visit(to);
    }
  }
}

}  // namespace arris
