#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "acquisition/types/triangle_mesh.hpp"
#include "registration/scene.hpp"

namespace arris {

/// A small cell of the CAD surface; CAD frame.
struct SurfaceCell {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, smooth over the triangles
  double area_mm2 = 0.0;
  double to_contours_mm = 0.0;  ///< distance from the accepted contours
};

/// The CAD surface within band_mm of its accepted contours (band_mm < 0: all of it) as cells of at most about
/// cell_mm.
/// Long thin triangles give more cells than their area asks for; the weights are areas, so nothing is
/// biased. Cost O(cells log n). Throws Error(kInput) when the band would need more than a million cells.
[[nodiscard]] std::vector<SurfaceCell> band_cells(const CadModel& cad, double band_mm, double cell_mm);

/// How far apart the field's nodes stand: beside the contours, where tools work, and farther into the part.
struct NodeSpacing {
  double beside_mm = 30.0, far_mm = 30.0;
  static constexpr double kGrowth = 0.2;  ///< of the distance from the contours; 0.35 left axes worse
  NodeSpacing() = default;
  NodeSpacing(double even_mm) : beside_mm(even_mm), far_mm(even_mm) {}  // NOLINT: an even spacing is one
  NodeSpacing(double beside, double far) : beside_mm(beside), far_mm(far) {}
  /// As wide as beside them for one spacing, then wider.
  [[nodiscard]] double at(double to_contours_mm) const {
    return std::min(far_mm, beside_mm + kGrowth * std::max(0.0, to_contours_mm - beside_mm));
  }
};

/// The field's nodes.
struct SurfaceNodes {
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> spacing_mm;  ///< from each to its neighbours
};

/// Fewer cells for the same surface: those whose centres share a cube of cell_ratio spacings (and a side)
/// become the one nearest to their middle, with their area.
[[nodiscard]] std::vector<SurfaceCell> thinned(const std::vector<SurfaceCell>& cells,
                                               const NodeSpacing& spacing, double cell_ratio);

/// Nodes on the contours and, farthest point first, between the cells, until every cell lies within
/// 0.75 spacings of a node whose normal agrees with its own. Deterministic; cost O(nodes * cells).
[[nodiscard]] SurfaceNodes place_nodes(const std::vector<const Curve*>& contours,
                                       const std::vector<SurfaceCell>& cells, const NodeSpacing& spacing);

}  // namespace arris
