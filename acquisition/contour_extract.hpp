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
  double sharp_edge_rad =
      0.52;  ///< a closed mesh: an edge whose faces turn more is a contour edge (30 degrees)
  double angle_gap_rad =
      1.5707963;  ///< a cloud: a loop begins at a point whose neighbours leave a larger gap
  double disc_spacings_ratio =
      2.0;  ///< a cloud: radius of the empty disc that rolls along the edge, in median spacings
  double outsized_edge_ratio =
      5.0;  ///< a mesh scan: a triangle edge longer than this times the median fills a hole
  double min_length_mm = 0.0;  ///< shorter loops are dropped; 0: twenty point spacings
  int threads = 0;
};

/// A contour with what the operator chooses by.
struct FoundContour {
  Contour contour;
  double length_mm = 0.0;
  double min_bend_radius_mm = 0.0;  ///< 0: a sharp corner of a drawing; a scan's is that of its ragged points
  double closing_gap_mm = 0.0;      ///< distance between the ends of an open chain; 0 when closed
  std::string note;  ///< "filled hole: 214 triangles without a scan point's density", "outer", ...
};

/// Loops found, longest first, ids from 1; dropped ones apart, with the reason in `note`.
struct ContourSet {
  std::vector<FoundContour> found;
  std::vector<FoundContour> dropped;
  std::vector<std::string>
      notes;  ///< oddities of the mesh, filled holes; a cloud that shows rows and no surface
};

/// Contours of a mesh. An open mesh: its one-face edges, chained to loops around the faces' fans, so that
/// loops which touch at a vertex stay apart. A closed mesh: smooth regions are flooded up to the edges
/// sharper than sharp_edge_rad, and each region's border is chained the same way; of two regions that share a
/// whole loop the one that faces the loop's plane keeps it (a rim belongs to the face, not to the wall of the
/// hole), of like ones the larger. Vertices must be welded (read_mesh does). Normals: the faces of the region
/// beside the edge. Orientation: material on the left, seen from the air side. No contours, but named in
/// `notes`: edges of more than two faces, and cracks without width between faces that do not share their
/// corners; neither makes a closed mesh an open one.
[[nodiscard]] ContourSet mesh_contours(const TriangleMesh& mesh, const ContourOptions& options);

/// Contours of a scan that is a mesh: as an open mesh, after the triangles that a scanner's software
/// stretched over holes are taken out (an edge longer than outsized_edge_ratio times the median); their rims
/// say so in `note`.
[[nodiscard]] ContourSet scan_mesh_contours(const Scan& scan, const ContourOptions& options);

/// Indices of the points whose 12 nearest leave an angle gap of more than angle_gap_rad in the tangent plane.
[[nodiscard]] std::vector<std::int32_t> boundary_points(std::span<const Eigen::Vector3d> points_mm,
                                                        const NearestPoints& tree, const LocalPlanes& planes,
                                                        const ContourOptions& options);

/// Contours of a cloud: an empty disc of disc_spacings_ratio median spacings rolls around the points in their
/// tangent planes and touches each loop's points in order (the border of a local alpha shape: Edelsbrunner et
/// al., IEEE Trans. Inf. Theory 29(4), 1983). A loop without an angle gap (boundary_points) is none. Points
/// that stand off their neighbours' plane (strays, the wall of a cut) are left out. Chains that break are
/// joined where their ends are near. The disc is one for the whole cloud: densities up to 4 : 1, and rows up
/// to five times finer along than across, show their edges; denser rows are named in `notes`. Loops shorter
/// than min_length_mm are voids of the sampling and dropped. `planes.normals` must be oriented alike; out of
/// the material for the material to lie on the left. Cost O(N log N); the loops do not depend on the order of
/// the points beyond where they start.
[[nodiscard]] ContourSet cloud_contours(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                                        const LocalPlanes& planes, const ContourOptions& options);

}  // namespace arris
