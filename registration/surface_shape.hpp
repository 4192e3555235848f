#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "registration/surface_basis.hpp"
#include "registration/surface_system.hpp"

namespace arris {

/// The deformed surface near one place: x -> x + u(x), CAD frame.
struct LocalShape {
  Eigen::Vector3d shift_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d f1 = Eigen::Vector3d::UnitX(), f2 = Eigen::Vector3d::UnitY();  ///< images of t1, t2
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();                             ///< deformed, unit
  /// Orthonormal rotation nearest to the deformation: carries (t1, t2, n) to the deformed frame.
  [[nodiscard]] Eigen::Matrix3d rotation(const BasisRow& row) const;
};
[[nodiscard]] LocalShape local_shape(const BasisRow& row, const std::vector<Eigen::Vector3d>& shift_mm);

/// How stiff the sheet is taken to be.
struct SheetPrior {
  double strain_ratio = 3e-4;  ///< expected in-surface strain of the mid-surface
  double bend_per_mm = 3e-4;   ///< expected change of curvature, but for that which all of the sheet shares:
  Eigen::Matrix3d common_bend_per_mm = Eigen::Matrix3d::Zero();  ///< CAD frame
  double unseen_bend_per_mm = 3e-4;  ///< the same as bend_per_mm, of cells that the scan does not show
  double thickness_mm = 0.0;         ///< of the sheet; the mid-surface lies half of it below the CAD's face
  double patch_mm = 50.0;            ///< the priors count once a square of this edge
};

/// Green's strain of the mid-surface and change of curvature of one cell, with their derivatives:
///   E_ab = (F_a . F_b - delta_ab) / 2 on the face; the mid-surface, t/2 below it, has E + t/2 (II' - II)
///   II' - II = n'. (x,ab + u,ab) - n . x,ab, with the normal's own variation in the derivative
/// A sheet bends almost without stretching its middle (Kirchhoff): both are residuals, by their expected
/// size.
class SheetCell {
 public:
  /// nodes_mm: places of the nodes, for the CAD's own curvature.
  SheetCell(const SurfaceCell& cell, const SurfaceBasis& basis);
  [[nodiscard]] bool usable() const { return row_.usable(); }
  [[nodiscard]] const BasisRow& row() const { return row_; }
  void set_seen(bool seen) { seen_ = seen; }
  void add(const std::vector<Eigen::Vector3d>& shift_mm, const SheetPrior& prior,
           SurfaceSystem& system) const;
  /// Strains 11, 12, 22, then bends less the common one.
  struct Terms {
    std::vector<Eigen::Matrix<double, 3, SurfaceSystem::kTogether>> derivative;  // of each node
    SurfaceSystem::Residuals residual, weight;
  };
  [[nodiscard]] Terms terms(const std::vector<Eigen::Vector3d>& shift_mm, const SheetPrior& prior) const;
  /// Strain of the mid-surface, components 11, 12, 22.
  [[nodiscard]] Eigen::Vector3d mid_strain(const std::vector<Eigen::Vector3d>& shift_mm,
                                           double thickness_mm) const;

 private:
  BasisRow row_;
  std::array<Eigen::Vector3d, 3> second_;  // x,11 x,12 x,22 of the CAD
  double area_mm2_ = 0.0;
  bool seen_ = true;
};

}  // namespace arris
