#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace arris {

class EdgeStrips;
struct ContourStation;

/// Edges that seem missing may lie elsewhere.
struct SeenElsewhere {
  double here_mm = 0.0;  ///< of the edges' length, what the scan shows less what it belies
  /// The contours, moved so, would be seen much better; CAD frame, 0: nowhere.
  Eigen::Vector3d by_mm = Eigen::Vector3d::Zero();
};

/// A fit that slid too far along a slot sees the slot's ends as gaps, and nothing calls it back. How the
/// contours would have to move along the part, if at all, for far more of them to be seen and no more
/// material to lie beyond them.
///   shift_mm    of the nodes, as the fit ended
///   spacing_mm  of the scan's points
///   lay         lays the strips under other shifts, walls not counted; they are left where it looked last
[[nodiscard]] SeenElsewhere seen_elsewhere(
    const EdgeStrips& strips, const std::vector<std::vector<ContourStation>>& contours,
    const std::vector<Eigen::Vector3d>& shift_mm, double spacing_mm,
    const std::function<void(const std::vector<Eigen::Vector3d>&)>& lay);

}  // namespace arris
