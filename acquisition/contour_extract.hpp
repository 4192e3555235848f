#pragma once

#include <span>
#include <string>
#include <vector>

#include "acquisition/geometry/nearest.hpp"
#include "acquisition/geometry/normals.hpp"
#include "acquisition/types/contour.hpp"
#include "acquisition/types/point_cloud.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Options of the contour search; recipe keys of [contour].
struct ContourOptions {
  double sharp_edge_rad = 0.52;       ///< a closed mesh: an edge whose faces turn more is a contour edge (30 degrees)
  double angle_gap_rad = 1.5707963;   ///< a cloud: a point whose neighbours leave a larger gap lies on the boundary
  double radius_spacings_ratio = 2.5; ///< neighbourhood of the gap test, in local point spacings
  double link_spacings_ratio = 3.5;   ///< boundary points farther apart than this are not chained
  double min_length_mm = 0.0;         ///< shorter loops are dropped; 0: twenty point spacings
  int threads = 0;
};

/// A contour with what the operator chooses by.
struct FoundContour {
  Contour contour;
  double length_mm = 0.0;
  double min_bend_radius_mm = 0.0;
  double closing_gap_mm = 0.0;     ///< distance between the ends of an open chain; 0 when closed
  std::string note;                ///< "filled hole: 214 triangles without a scan point's density", "outer", ...
};

/// Loops found, longest first, ids from 1; dropped ones apart, with the reason in `note`.
struct ContourSet {
  std::vector<FoundContour> found;
  std::vector<FoundContour> dropped;
};

/// Contours of a mesh: one-face edges chained into loops when it is open, else sharp edges chained between corners
/// into loops. Vertices must be welded (read_mesh does). Normals: the mean of the faces beside the edge.
/// Orientation: material on the left, seen from the air side. Throws Error(kInput) for a non-manifold boundary.
[[nodiscard]] ContourSet mesh_contours(const TriangleMesh& mesh, const ContourOptions& options);

/// Indices of the boundary points of a cloud, by the largest angle gap between neighbours in the tangent plane.
[[nodiscard]] std::vector<std::int32_t> boundary_points(std::span<const Eigen::Vector3d> points_mm,
                                                        const NearestPoints& tree, const LocalPlanes& planes,
                                                        const ContourOptions& options);

/// Boundary points chained to ordered loops; loops that are too short, or open by more than 3 link lengths, dropped.
/// `planes.normals` must be oriented (out of the material) for the loops to be oriented.
[[nodiscard]] ContourSet cloud_contours(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                                        const LocalPlanes& planes, const ContourOptions& options);

}  // namespace arris
