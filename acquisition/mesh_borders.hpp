#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Which triangle lies across each side of each triangle. Side k runs from corner k to corner k + 1.
struct MeshAdjacency {
  static constexpr std::int32_t kNone = -1;     ///< one-face edge
  static constexpr std::int32_t kCrowded = -2;  ///< edge of more than two faces, or of two that wind alike
  std::vector<std::array<std::int32_t, 3>> across;
  std::size_t crowded_edges = 0;

  [[nodiscard]] std::int32_t at(std::int32_t triangle, int side) const {
    return across[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(side)];
  }
};

/// Cost O(n log n).
[[nodiscard]] MeshAdjacency adjacency(const TriangleMesh& mesh);

/// One directed border edge: side `side` of triangle `triangle`.
struct BorderEdge {
  std::int32_t triangle = 0;
  int side = 0;
};

/// Cuts a loop that comes through a vertex twice (two holes that touch there) into loops that do not.
void append_simple_loops(const TriangleMesh& mesh, const std::vector<BorderEdge>& loop,
                         std::vector<std::vector<BorderEdge>>& loops);

/// Chains the border edges of a mesh to directed loops, turning around the fan of faces at each vertex:
/// pieces that touch at a vertex stay apart, and so do holes. is_border(triangle, side) decides what a border
/// is, a side without one neighbour always; material lies on the left of each edge seen from outside.
template <class IsBorder>
[[nodiscard]] std::vector<std::vector<BorderEdge>> border_loops(const TriangleMesh& mesh,
                                                                const MeshAdjacency& neighbours,
                                                                const IsBorder& is_border) {
  std::vector<std::vector<BorderEdge>> loops;
  std::vector<std::array<char, 3>> done(mesh.triangles.size(), {0, 0, 0});
  const auto corner = [&](std::int32_t t, int k) {
    return mesh.triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
  };
  for (std::size_t start = 0; start < mesh.triangles.size(); ++start)
    for (int side = 0; side < 3; ++side) {
      const std::int32_t first = static_cast<std::int32_t>(start);
      if (done[start][static_cast<std::size_t>(side)] || !is_border(first, side)) continue;
      std::vector<BorderEdge> loop;
      BorderEdge edge{first, side};
      while (!done[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.side)]) {
        done[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.side)] = 1;
        loop.push_back(edge);
        // Turn around the edge's end vertex through the faces that share it, until the next border edge.
        std::int32_t t = edge.triangle;
        int k = (edge.side + 1) % 3;
        for (std::size_t turns = 0; !is_border(t, k) && turns < mesh.triangles.size(); ++turns) {
          const std::int32_t vertex = corner(t, k);
          t = neighbours.across[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
          k = corner(t, 0) == vertex ? 0 : corner(t, 1) == vertex ? 1 : 2;
        }
        edge = {t, k};
      }
      append_simple_loops(mesh, loop, loops);
    }
  return loops;
}

}  // namespace arris
