#include "registration/common_strain.hpp"

#include <array>
#include <cmath>

namespace arris {
namespace {

constexpr double kAboutOpenings = 3.0;  // of the prior's strain

/// Orthonormal symmetric tensors.
std::array<Eigen::Matrix3d, 6> strain_modes() {
  std::array<Eigen::Matrix3d, 6> modes;
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = i; k < 3; ++k) {
      Eigen::Matrix3d mode = Eigen::Matrix3d::Zero();
      mode(i, k) = mode(k, i) = i == k ? 1.0 : std::sqrt(0.5);
      modes[at++] = mode;
    }
  return modes;
}

}  // namespace

Eigen::MatrixXd moves_by_common_strain(std::span<const SheetCell> sheet,
                                       const std::vector<Eigen::Vector3d>& shift_mm, const SheetPrior& prior,
                                       const Eigen::MatrixXd& covariance) {
  std::array<Eigen::Matrix3d, 6> strains = strain_modes();
  for (Eigen::Matrix3d& strain : strains) strain *= kAboutOpenings * prior.strain_ratio;
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(covariance.rows(), static_cast<Eigen::Index>(strains.size()));
  for (const SheetCell& cell : sheet) cell.add_pull(shift_mm, prior, strains, pull);
  return covariance * pull;
}

}  // namespace arris
