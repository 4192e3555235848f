#pragma once

#include <vector>

#include "registration/subdivision_icp.hpp"

namespace arris {

/// How far two neighbouring segments of a contour disagree at their common cut.
struct Seam {
  std::size_t before = 0, after = 0;  ///< segments
  double arc_mm = 0.0;
  double jump_mm = 0.0;  ///< of the cut's place; without the part along the contour, which moves no edge
  double turn_rad = 0.0;
};

/// The seams in order along the contour; on a closed one the last joins the first. A lone segment has none.
[[nodiscard]] std::vector<Seam> seams_of(const ContourMotion& motion);

}  // namespace arris
