#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "registration/surface_shape.hpp"

namespace arris {

/// What the field may owe to a strain that all of the sheet shares. The prior takes the strain of each patch
/// for its own, so that many patches together hardly strain by it; the field calls a shared strain a slide
/// along the contour. An opening strains its rim three times as much as the sheet about it (Kirsch, Z. VDI
/// 42, 1898), and that often is what it is taken to be. The fit is not moved by this: the strain is
/// considered, not estimated (Schmidt, Adv. Control Systems 3, 1966).
///   covariance  of the nodes' shifts (3 each), then the offsets, by the fit; mm^2
///   returns     a row for each of those, a column for each of six strains that are independent and as likely
///               in any direction: how far one standard deviation of it moves the fit, mm
///   cost        O(cells + unknowns^2)
[[nodiscard]] Eigen::MatrixXd moves_by_common_strain(std::span<const SheetCell> sheet,
                                                     const std::vector<Eigen::Vector3d>& shift_mm,
                                                     const SheetPrior& prior,
                                                     const Eigen::MatrixXd& covariance);

}  // namespace arris
