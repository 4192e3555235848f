#pragma once

#include <Eigen/Core>
#include <vector>

#include "acquisition/types/contour.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Unit normals of the surface that a sheet's triangles stand for, one a vertex, on the side of the faces.
/// The area-weighted mean of the faces is taken first; at the rim, where faces lie on one side only, it is
/// half a face's turn wrong. So a quadric is fitted to the vertices within two rings, and its normal taken
/// (Cazals and Pouget, Computer Aided Geometric Design 22(2), 2005). Where the faces of the rings turn by
/// more than crease_rad, or the quadric would turn the mean by more than that, the mean stays. Cost O(n).
[[nodiscard]] std::vector<Eigen::Vector3d> sheet_normals(const TriangleMesh& mesh, double crease_rad);

/// One face of a sheet and what lies at a constant distance from it, vertex by vertex: the other face, or the
/// mid-surface.
struct OffsetFace {
  TriangleMesh mesh;                     ///< the same triangles over moved vertices
  std::vector<Eigen::Vector3d> normals;  ///< of the face at its vertices, unit
};

/// Moves each vertex along the surface's normal there, so that a rim stays a rim and loops stay loops.
///   along_mm   positive: the way that the normals point
///   throws     Error(kInput): a triangle turns over or shrinks to a tenth: along_mm reaches the bend radius
[[nodiscard]] OffsetFace offset_face(const TriangleMesh& sheet, double along_mm, double crease_rad);

/// The same face seen from its other side: triangles wound the other way round, normals reversed.
[[nodiscard]] OffsetFace turned(OffsetFace face);

/// The loops of `face` that were `contours` on `sheet`, whose vertices they run through; ids and sources are
/// kept. On a turned face they run the other way round, with the material on the left again.
///   throws   Error(kBug): a contour point that is no vertex of the sheet
///   cost     O(n log n)
[[nodiscard]] std::vector<Contour> contours_on(const OffsetFace& face, const TriangleMesh& sheet,
                                               const std::vector<Contour>& contours);

}  // namespace arris
