#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "acquisition/mesh_borders.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Twice the area of triangle t, along its normal; mm^2.
[[nodiscard]] Eigen::Vector3d double_area_mm2(const TriangleMesh& mesh, std::size_t t);

/// Side of triangle t from its corner `side` to the next; mm.
[[nodiscard]] double side_mm(const TriangleMesh& mesh, std::size_t t, std::size_t side);

/// The longest of a triangle's sides; ties: the first.
[[nodiscard]] std::size_t longest_side(const TriangleMesh& mesh, std::size_t t);

/// Unit normals. A triangle that is flat to a line (tessellators make them) takes the normal of the face
/// across its longest side, so that it belongs to that face.
[[nodiscard]] std::vector<Eigen::Vector3d> face_normals(const TriangleMesh& mesh,
                                                        const MeshAdjacency& neighbours);

/// Smooth regions of a mesh: triangles joined across every side that is not sharp. A flat face, a fillet that
/// runs into it, the wall of a round hole are one region each.
struct SmoothRegions {
  std::vector<int> of;  ///< region of each triangle
  std::vector<double> area_mm2;
  std::vector<Eigen::Vector3d> mean_normal;  ///< area-weighted, not normalised: length 1 when flat, 0 closed
};

/// Floods from the lowest triangle up to sides whose faces turn by more than sharp_edge_rad. Cost O(n).
[[nodiscard]] SmoothRegions smooth_regions(const TriangleMesh& mesh, const MeshAdjacency& neighbours,
                                           const std::vector<Eigen::Vector3d>& normals,
                                           double sharp_edge_rad);

}  // namespace arris
