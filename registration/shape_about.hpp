#pragma once

#include <Eigen/Core>
#include <vector>

#include "registration/carried_contour.hpp"
#include "registration/scene.hpp"
#include "registration/surface_basis.hpp"
#include "registration/surface_shape.hpp"

namespace arris {

/// The deformed surface about a place of the CAD, its tangents those of the plane that fits the field's own
/// values there and on two rings about it best, 0.4 node spacings wide or as far as the material goes. The
/// local polynomial's slopes (local_shape) are worst at a free edge, where tools work: axes there were off
/// three to five times as far by them. A wider ring gives the turn of its middle, not of the edge; a
/// quadratic through the rings follows what the nodes beside a free edge do not hold (both measured, and
/// worse).
///   foot_mm  on the CAD's surface; row: there
///   falls back to local_shape() where the material is too narrow to tell
///   cost     16 surface queries and rows
[[nodiscard]] LocalShape shape_about(const CadModel& cad, const SurfaceBasis& basis,
                                     const Eigen::Vector3d& foot_mm, const BasisRow& row,
                                     const std::vector<Eigen::Vector3d>& shift_mm);

/// Slope of the deformed surface against the nominal one across each contour, one a station; rad.
[[nodiscard]] std::vector<double> edge_slopes(const CadModel& cad, const SurfaceBasis& basis,
                                              const std::vector<std::vector<ContourStation>>& contours,
                                              const std::vector<Eigen::Vector3d>& shift_mm);

}  // namespace arris
