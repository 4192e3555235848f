#pragma once

#include <span>

#include "acquisition/types/contour.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// How a tool path is laid along a contour (recipe [toolpath] from_contour). Void: the side without material.
struct FromContourOptions {
  double offset_mm = 0.0;    ///< of the tip from the contour, in the surface, positive towards the void: of a
                             ///< hole and of an outline alike
  double depth_mm = 0.0;     ///< of the tip below the surface, along the normal
  double lateral_rad = 0.0;  ///< the axis leans over towards the void; in (-pi/2, pi/2)
  double lead_rad = 0.0;     ///< the axis leans over towards the travel; in (-pi/2, pi/2)
  double step_mm = 2.0;      ///< largest distance of two rows along the contour; > 0
  double chord_error_mm = 0.02;  ///< largest distance of the contour from the chord of two rows; > 0
  double seam_mm =
      0.0;  ///< of a closed contour: where the path begins, along the contour from its first point
  bool reversed = false;     ///< against the contour, which has the material on the left
  double approach_mm = 0.0;  ///< a row this far above the first, along the axis; 0: none
  double retract_mm = 0.0;   ///< a row this far above the last, along the axis; 0: none
  double feed_mm_s = 0.0;    ///< of every row; 0: the cell's
  void check() const;        ///< throws Error(kRecipe) that names field, value and bound
};

/// A nominal tool path along contours, one polyline each, numbered from 1 in the order given.
///   corners   are kept: round an outer corner the offset path goes in an arc, in an inner corner it meets in
///   a point;
///             rows that would come nearer to the contour than the offset are left out
///   closed    a closed contour gives a closed polyline; with approach or retract an open one that ends where
///   it began throws    Error(kInput): a contour without normals or with fewer than two distinct points;
///   Error(kRecipe): options,
///             an offset that the contour has no room for, a seam on an open contour
///   cost      O(n log n) in the number of rows and points
[[nodiscard]] ToolPath path_from_contours(std::span<const Contour> contours,
                                          const FromContourOptions& options);

}  // namespace arris
