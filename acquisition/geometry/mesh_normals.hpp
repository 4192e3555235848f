#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Angle-weighted pseudo-normals of a mesh and its border: what decides the side of a point whose foot lies
/// on an edge or a corner. Edge k of a triangle runs from its vertex k to vertex k + 1. Source: Baerentzen
/// and Aanaes, IEEE TVCG 11(3), 2005.
struct MeshNormals {
  std::vector<Eigen::Vector3d> face;    ///< unit; a flat-to-nothing triangle takes its neighbours' mean
  std::vector<Eigen::Vector3d> edge;    ///< by edge id: unit sum of the faces at the edge
  std::vector<Eigen::Vector3d> vertex;  ///< unit sum of the faces, each times its angle there
  std::vector<std::array<std::int32_t, 3>> edge_of;  ///< a triangle's three edge ids
  std::vector<std::uint8_t> edge_is_border;          ///< by edge id: one face only
  std::vector<std::uint8_t> vertex_is_border;        ///< an end of a border edge
  std::vector<std::uint8_t> degenerate;  ///< by triangle: no area (height below 1e-12 of its longest edge)
};

/// The same bits for any number of threads (0: all of the machine). Cost O(n log n). Throws Error(kBug) when
/// a triangle names a vertex that is not there.
[[nodiscard]] MeshNormals mesh_normals(const TriangleMesh& mesh, int threads = 0);

/// Its first half, `face` and `degenerate`, and its second: who needs the first alone to go on with does the
/// second meanwhile. The second changes `face` of what is degenerate.
[[nodiscard]] MeshNormals face_normals(const TriangleMesh& mesh, int threads = 0);
void add_edge_and_vertex_normals(const TriangleMesh& mesh, int threads, MeshNormals& normals);

}  // namespace arris
