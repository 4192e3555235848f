#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace arris {

/// Motions that the data leave free, in words ("turn about the axis (0.00 0.00 1.00) through (..)"):
/// eigenvectors of the information matrix, rotation scaled by the contour's size, below 1e-4 of the largest
/// (slippage: Gelfand and Guibas 2003).
[[nodiscard]] std::vector<std::string> free_directions(const Eigen::Matrix<double, 6, 6>& information,
                                                       const Eigen::Vector3d& pivot_mm, double size_mm);

}  // namespace arris
