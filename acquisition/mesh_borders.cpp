#include "acquisition/mesh_borders.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <unordered_map>

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
  result.across.assign(mesh.triangles.size(),
                       {MeshAdjacency::kNone, MeshAdjacency::kNone, MeshAdjacency::kNone});
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high)
      ++end;
    if (end - begin == 2 && sides[begin].forward != sides[begin + 1].forward) {
      const Side &a = sides[begin], &b = sides[begin + 1];
      result.across[static_cast<std::size_t>(a.triangle)][static_cast<std::size_t>(a.side)] = b.triangle;
      result.across[static_cast<std::size_t>(b.triangle)][static_cast<std::size_t>(b.side)] = a.triangle;
    } else if (end - begin > 1) {
      ++result.crowded_edges;
      for (std::size_t k = begin; k < end; ++k)
        result.across[static_cast<std::size_t>(sides[k].triangle)][static_cast<std::size_t>(sides[k].side)] =
            MeshAdjacency::kCrowded;
    }
    begin = end;
  }
  return result;
}

void append_simple_loops(const TriangleMesh& mesh, const std::vector<BorderEdge>& loop,
                         std::vector<std::vector<BorderEdge>>& loops) {
  std::vector<BorderEdge> open;
  std::unordered_map<std::int32_t, std::size_t>
      place;  // on `open`, of each vertex that an edge of it starts at
  const auto start_of = [&](const BorderEdge& edge) {
    return mesh.triangles[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.side)];
  };
  for (const BorderEdge& edge : loop) {
    const auto [entry, fresh] = place.try_emplace(start_of(edge), open.size());
    if (!fresh) {
      const auto first = open.begin() + static_cast<std::ptrdiff_t>(entry->second);
      loops.emplace_back(first, open.end());
      for (auto cut = std::next(first); cut != open.end(); ++cut) place.erase(start_of(*cut));
      open.erase(first, open.end());
    }
    open.push_back(edge);
  }
  if (!open.empty()) loops.push_back(std::move(open));
}

}  // namespace arris
