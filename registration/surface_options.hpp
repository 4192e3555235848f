#pragma once

#include "registration/scanner_edge.hpp"
#include "registration/surface_shape.hpp"

namespace arris {

/// What the edges of the drawing tell.
enum class ContourRole {
  kEdge,  ///< accepted contours are on the part: their edges are data, and the path follows them
  kCut    ///< the tool makes them: their edges, if any, are no data; the drawing's other contours are
};

/// Options of refine_surface(). Lengths in mm of the CAD.
struct SurfaceOptions {
  double band_mm = 60.0;  ///< the field lives on the CAD within this of the contours (role cut: on all)
  double node_spacing_mm = 30.0;  ///< of the field's nodes; wider when the surface would need too many
  SheetPrior prior;
  double edge_share_ratio = 0.33;  ///< an edge is known up to a smooth shift over this share of its length
  double strip_mm = 10.0;          ///< widest strip of material whose density the edge is judged by
  double offset_sd_mm = 0.5;       ///< how much larger or smaller than drawn a contour may be, all round
  ScannerEdge scanner;             ///< taken off what the scan shows of an edge
  ContourRole role = ContourRole::kEdge;
  double stock_mm = 0.0;         ///< role cut: material that the contour still carries
  double start_scale_mm = 10.0;  ///< robust scale at the start: about what the rigid motion leaves
  int max_rounds = 40;
  int threads = 0;
  void check() const;  ///< throws Error(kRecipe) naming field, value and bound
};

}  // namespace arris
