#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "registration/surface_shape.hpp"
#include "registration/surface_system.hpp"

namespace arris {

/// A change of curvature that all of the sheet shares, about which its places scatter: what a part sprung
/// back, or laid over a form, shows. Nothing is known of it beforehand, so it is taken out of the equations
/// (marginalised). The priors' bends, as a quadratic form of the field and of its six components (of
/// symmetric_modes(), CAD frame).
struct CommonBend {
  Eigen::MatrixXd with_field;               ///< rows as the system's unknowns, a column a component
  Eigen::Matrix<double, 6, 6> information;  ///< without what is known beforehand
  Eigen::Matrix<double, 6, 1> pull;         ///< of the field's bends, not of their deviations
  double squares = 0.0;                     ///< weighted, of the deviations from prior.common_bend_per_mm

  /// Of a system to which the same cells' priors have been added `times` as strong.
  void take_out_of(SurfaceSystem& system, double times = 1.0) const;
  /// The likeliest one for the field as it is.
  [[nodiscard]] Eigen::Matrix3d likeliest_per_mm() const;
};

/// cost  O(cells * 25)
[[nodiscard]] CommonBend common_bend(std::span<const SheetCell> sheet,
                                     const std::vector<Eigen::Vector3d>& shift_mm, const SheetPrior& prior,
                                     Eigen::Index unknowns);

}  // namespace arris
