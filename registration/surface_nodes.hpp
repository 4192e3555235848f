#pragma once

#include <Eigen/Core>
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
};

/// The CAD surface within band_mm of its accepted contours (band_mm < 0: all of it) as cells of at most about
/// cell_mm.
/// Long thin triangles give more cells than their area asks for; the weights are areas, so nothing is
/// biased. Cost O(cells log n). Throws Error(kInput) when the band would need more than a million cells.
[[nodiscard]] std::vector<SurfaceCell> band_cells(const CadModel& cad, double band_mm, double cell_mm);

/// Places of the field's nodes.
struct SurfaceNodes {
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<Eigen::Vector3d> normals;
};

/// Fewer cells for the same surface: those whose centres share a cube of cell_mm (and a side) become the one
/// nearest to their middle, with their area.
[[nodiscard]] std::vector<SurfaceCell> thinned(const std::vector<SurfaceCell>& cells, double cell_mm);

/// Nodes on the contours and, farthest point first, between the cells, until every cell lies within
/// 0.75 spacing_mm of a node whose normal agrees with its own. Deterministic; cost O(nodes * cells).
[[nodiscard]] SurfaceNodes place_nodes(const std::vector<const Curve*>& contours,
                                       const std::vector<SurfaceCell>& cells, double spacing_mm);

}  // namespace arris
