#include "acquisition/mesh_borders.hpp"

#include <algorithm>
#include <tuple>

namespace arris {
namespace {

struct Side {
  std::int32_t low, high, triangle;
  int side;
  bool forward;  // runs from low to high
};

}  // namespace

MeshAdjacency adjacency(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangles[t][static_cast<std::size_t>(k)];
      const std::int32_t b = mesh.triangles[t][static_cast<std::size_t>((k + 1) % 3)];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), k, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side);
  });
  MeshAdjacency result;
  result.across.assign(mesh.triangles.size(), {MeshAdjacency::kNone, MeshAdjacency::kNone, MeshAdjacency::kNone});
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    if (end - begin == 2 && sides[begin].forward != sides[begin + 1].forward) {
      const Side &a = sides[begin], &b = sides[begin + 1];
      result.across[static_cast<std::size_t>(a.triangle)][static_cast<std::size_t>(a.side)] = b.triangle;
      result.across[static_cast<std::size_t>(b.triangle)][static_cast<std::size_t>(b.side)] = a.triangle;
    } else if (end - begin > 1) {
      ++result.crowded_edges;
    }
    begin = end;
  }
  return result;
}

}  // namespace arris
