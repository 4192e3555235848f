#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace arris {

/// An ordered polyline on an edge of the part: a hole, a slot, an outline; mm.
struct Contour {
  int id = 0;                              ///< numbered from 1 within its file, longest first
  bool closed = false;                     ///< the last point joins the first, which is not repeated
  std::vector<Eigen::Vector3d> points_mm;  ///< in order; material on the left seen against the normal
  std::vector<Eigen::Vector3d> normals;    ///< unit, out of the material, one a point; empty when unknown
  std::string source;                      ///< "boundary", "sharp edge", "angle gap", "file", ...
};

/// Length along the polyline, closing chord included when closed; mm.
[[nodiscard]] double length_mm(const Contour& contour);

}  // namespace arris
