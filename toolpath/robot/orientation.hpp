#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace arris {

/// What turns the tool about its own axis, which a path leaves free (recipe [toolpath] spin).
enum class Spin {
  kFixed,      ///< tool x as near as can be to one fixed direction
  kTangent,    ///< tool x along the travel
  kLeastTurn,  ///< from row to row the smallest turn that brings the axis along: no spin of its own
};

/// "fixed", "tangent", "least_turn"; throws Error(kRecipe) for any other word.
[[nodiscard]] Spin spin_from_name(const std::string& name);

/// Full tool orientations: columns x, y, z of the tool, z = -axis.
///   axes     unit, out of the material
///   travel   direction of travel of each row (any length); used by kTangent alone. Where it is missing or
///   along the
///            axis (approach, retract, a single row) the row takes that of the last row that has one, else
///            the next
///   kFixed   the fixed direction is the first of x, y, z that stays 30 degrees off every axis, else the best
///   of them throws   Error(kInput) if kFixed has no direction that stays 1 degree off; Error(kBug) if the
///   widths differ cost     O(N)
[[nodiscard]] std::vector<Eigen::Matrix3d> tool_frames(const std::vector<Eigen::Vector3d>& axes,
                                                       const std::vector<Eigen::Vector3d>& travel, Spin spin);

}  // namespace arris
