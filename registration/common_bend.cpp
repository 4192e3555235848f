#include "registration/common_bend.hpp"

#include <Eigen/Cholesky>

#include "registration/symmetric_modes.hpp"

namespace arris {
namespace {

using Six = Eigen::Matrix<double, 6, 6>;

constexpr double kExpectedPerMm = 1e-3;  // wide: a radius of a metre

Six with_expectation(const Six& information) {
  return information + Six::Identity() / (kExpectedPerMm * kExpectedPerMm);
}

}  // namespace

void CommonBend::take_out_of(SurfaceSystem& system, double times) const {
  const Eigen::LLT<Six> root(with_expectation(times * information));
  system.taken = times * root.matrixL().solve(with_field.transpose()).transpose();
}

Eigen::Matrix3d CommonBend::likeliest_per_mm() const {
  const Eigen::Matrix<double, 6, 1> components = with_expectation(information).llt().solve(pull);
  Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
  for (std::size_t mode = 0; mode < symmetric_modes().size(); ++mode)
    bend += components[static_cast<Eigen::Index>(mode)] * symmetric_modes()[mode];
  return bend;
}

CommonBend common_bend(std::span<const SheetCell> sheet, const std::vector<Eigen::Vector3d>& shift_mm,
                       const SheetPrior& prior, Eigen::Index unknowns) {
  CommonBend common{Eigen::MatrixXd::Zero(unknowns, 6), Six::Zero(), Eigen::Matrix<double, 6, 1>::Zero(),
                    0.0};
  for (const SheetCell& cell : sheet) {
    const SheetCell::Terms of = cell.terms(shift_mm, prior);
    Eigen::Matrix<double, 3, 6> components;
    for (std::size_t mode = 0; mode < symmetric_modes().size(); ++mode)
      components.col(static_cast<Eigen::Index>(mode)) = in_frame(symmetric_modes()[mode], cell.row());
    const Eigen::Vector3d off = of.residual.tail<3>(), weight = of.weight.tail<3>(),
                          bend = off + in_frame(prior.common_bend_per_mm, cell.row());
    const Eigen::Matrix<double, 3, 6> weighted = weight.asDiagonal() * components;
    common.information += components.transpose() * weighted;
    common.pull += weighted.transpose() * bend;
    common.squares += off.dot(weight.cwiseProduct(off));
    for (std::size_t j = 0; j < of.derivative.size(); ++j)
      common.with_field.middleRows<3>(3 * cell.row().node[j]) += of.derivative[j].rightCols<3>() * weighted;
  }
  return common;
}

}  // namespace arris
