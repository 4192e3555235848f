#include "registration/common_strain.hpp"

#include "registration/symmetric_modes.hpp"

namespace arris {
namespace {

constexpr double kAboutOpenings = 3.0;  // of the prior's strain

}  // namespace

Eigen::MatrixXd moves_by_common_strain(std::span<const SheetCell> sheet,
                                       const std::vector<Eigen::Vector3d>& shift_mm, const SheetPrior& prior,
                                       const Eigen::MatrixXd& covariance) {
  const std::array<Eigen::Matrix3d, 6>& modes = symmetric_modes();
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(covariance.rows(), static_cast<Eigen::Index>(modes.size()));
  for (const SheetCell& cell : sheet) {
    const SheetCell::Terms of = cell.terms(shift_mm, prior);
    for (std::size_t mode = 0; mode < modes.size(); ++mode) {
      const Eigen::Vector3d strain = kAboutOpenings * prior.strain_ratio * in_frame(modes[mode], cell.row()),
                            here = of.weight.head<3>().cwiseProduct(strain);
      for (std::size_t j = 0; j < of.derivative.size(); ++j)
        pull.col(static_cast<Eigen::Index>(mode)).segment<3>(3 * cell.row().node[j]) +=
            of.derivative[j].leftCols<3>() * here;
    }
  }
  return covariance * pull;
}

}  // namespace arris
