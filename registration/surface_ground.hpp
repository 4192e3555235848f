#pragma once

#include <memory>
#include <vector>

#include "registration/carried_contour.hpp"
#include "registration/scene.hpp"
#include "registration/surface_basis.hpp"
#include "registration/surface_shape.hpp"

namespace arris {

/// What a surface field stands on: its nodes, the cells that its priors are taken over, and the contours that
/// it carries.
struct SurfaceGround {
  static constexpr std::size_t kMostNodes = 400;

  std::shared_ptr<const SurfaceBasis> basis;
  std::vector<SheetCell> sheet;
  std::vector<std::vector<ContourStation>> contours;  ///< the accepted ones
  double area_mm2 = 0.0;

  [[nodiscard]] bool too_fine() const { return basis->size() > kMostNodes; }
};

/// Nodes as far apart as asked, or as few of them as there may be: on the CAD within band_mm of its accepted
/// contours (< 0: all of it, and nodes on its other contours too).
[[nodiscard]] SurfaceGround even_ground(const CadModel& cad, double band_mm, double spacing_mm);

/// Nodes beside_mm apart beside the contours and, where that would be too many, up to far_mm apart farther
/// into the part. too_fine() when even those are too many.
[[nodiscard]] SurfaceGround graded_ground(const CadModel& cad, double band_mm, double beside_mm,
                                          double far_mm);

}  // namespace arris
