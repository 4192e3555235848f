#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "acquisition/smooth_regions.hpp"
#include "acquisition/types/contour.hpp"
#include "acquisition/types/triangle_mesh.hpp"
#include "acquisition/vertex_at.hpp"

namespace arris {

/// How thick a solid is behind one of its faces.
struct SolidThickness {
  double median_mm = 0.0;
  double spread_mm = 0.0;  ///< between the 10 % and the 90 % quantile: 0 for a plate
  bool known = false;      ///< false: nothing faces the other way
};

/// The faces of a closed mesh told apart: smooth regions, and for each contour of mesh_contours() the face
/// whose rim it is and the walls beyond it. Frame and unit of the mesh, which must outlive it.
class SolidFaces {
 public:
  SolidFaces(const TriangleMesh& solid, double sharp_edge_rad);

  /// The region on the left of a contour: the face whose rim it is. Throws Error(kBug) for one that does not
  /// run along the mesh's sides.
  [[nodiscard]] int face_of(const Contour& contour) const { return regions_beside(contour, false).front(); }
  /// Of `all`, the contour at the other end of the same walls that faces the other way, as the two rims of a
  /// hole through a plate do; the nearest if several do, null if none does.
  [[nodiscard]] const Contour* partner_of(const Contour& contour, std::span<const Contour> all) const;
  /// The regions that can be seen together with `faces`: themselves, and those whose normals lie within 60
  /// degrees of `towards` (unit) on the mean. Walls at right angles and the far side are left out.
  [[nodiscard]] std::vector<int> visible_with(std::vector<int> faces, const Eigen::Vector3d& towards) const;
  /// The triangles of some regions.
  [[nodiscard]] TriangleMesh mesh_of(const std::vector<int>& regions) const;
  /// Distance from the middles of up to 400 triangles of `face` to what faces the other way.
  [[nodiscard]] SolidThickness thickness_behind(int face) const;

 private:
  [[nodiscard]] std::vector<int> regions_beside(const Contour& contour, bool beyond) const;

  const TriangleMesh& solid_;
  SmoothRegions regions_;
  VertexAt vertex_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> triangle_of_side_;
};

}  // namespace arris
