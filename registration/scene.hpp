#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "acquisition/geometry/nearest.hpp"
#include "acquisition/geometry/polyline.hpp"
#include "acquisition/geometry/surface_query.hpp"
#include "acquisition/types/contour.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Unit direction in the surface at s of a contour, across it, into the material: normal x tangent.
[[nodiscard]] Eigen::Vector3d inward_of(const Curve& contour, double arc_mm);

/// Curvature of a contour in the surface at s, 1/mm: positive where the material fans out behind it (the
/// inside corner of a hole).
[[nodiscard]] double fan_per_mm(const Curve& contour, double arc_mm);

/// The drawing, ready for queries: frame Cad, mm. Built once a part number.
struct CadModel {
  SurfaceQuery surface;
  std::vector<Curve>
      contours;  ///< accepted contours, each with normals; material on the left seen against them

  std::vector<Curve> others = {};  ///< contours that are not followed; they tell poses apart
  TriangleMesh mesh = {};          ///< what `surface` was built from
  std::vector<Eigen::Vector3d> vertex_normals = {};  ///< smooth, unit, one a vertex of `mesh`

  /// Unit direction in the surface at s, across contour c, into the material: normal x tangent.
  [[nodiscard]] Eigen::Vector3d inward(std::size_t c, double arc_mm) const;
  /// Unit normal at a foot, interpolated over its triangle: smooth where the drawing is.
  [[nodiscard]] Eigen::Vector3d smooth_normal(const SurfacePoint& foot) const;
};

/// The contour that passes nearest to a point, and where; foot.segment -1 when there is no contour. Ties: the
/// lower index. O(contours log n).
struct NearestContour {
  std::size_t contour = 0;
  CurveFoot foot;
};
[[nodiscard]] NearestContour nearest_contour(std::span<const Curve> contours, const Eigen::Vector3d& p_mm);

/// How the scan's normals got their sign; decides whether both sides of the part must be tried.
enum class SideKnown { kNo, kYes };

/// One scan, ready for queries: frame Scan about the cloud's offset, mm, double.
struct ScanModel {
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<Eigen::Vector3d>
      normals;  ///< unit, one a point; out of the material if side == kYes, else consistent
  NearestPoints tree{std::span<const Eigen::Vector3d>{}};  ///< over points_mm
  std::vector<Contour> loops;            ///< found contours, oriented like the CAD's when side == kYes
  std::vector<Eigen::Vector3d> edge_mm;  ///< all points of all loops: where the scan stops
  std::vector<Eigen::Vector3d> edge_normals;
  double spacing_mm = 0.0;  ///< median point spacing
  double noise_sigma_mm = 0.0;
  SideKnown side = SideKnown::kNo;
  std::vector<char> loop_rejected = {};  ///< an operator's choice, one a loop: never used; empty: none is
  [[nodiscard]] bool is_rejected(std::size_t loop) const {
    return loop < loop_rejected.size() && loop_rejected[loop] != 0;
  }
};

}  // namespace arris
