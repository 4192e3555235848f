#include "registration/surface_shape.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "registration/symmetric_modes.hpp"

namespace arris {
namespace {

constexpr std::array<std::array<int, 2>, 3> kPairs = {{{0, 0}, {0, 1}, {1, 1}}};
constexpr std::array<double, 3> kMultiplicity = {1.0, 2.0, 1.0};  // 12 stands for 21 as well

}  // namespace

Eigen::Matrix3d LocalShape::rotation(const BasisRow& row) const {
  // Symmetric: the mean direction of (f1 + f2) and (f1 - f2) is kept, so that neither tangent is favoured.
  const Eigen::Vector3d sum = (f1.normalized() + f2.normalized()).normalized();
  const Eigen::Vector3d side = normal.cross(sum);
  Eigen::Matrix3d deformed, nominal;
  deformed << (sum - side) / std::sqrt(2.0), (sum + side) / std::sqrt(2.0), normal;
  nominal << row.t1, row.t2, row.normal;
  return deformed * nominal.transpose();
}

LocalShape local_shape(const BasisRow& row, const std::vector<Eigen::Vector3d>& shift_mm) {
  LocalShape shape;
  shape.shift_mm = row.combine(BasisRow::kValue, shift_mm);
  shape.f1 = row.t1 + row.combine(BasisRow::kD1, shift_mm);
  shape.f2 = row.t2 + row.combine(BasisRow::kD2, shift_mm);
  shape.normal = shape.f1.cross(shape.f2).normalized();
  return shape;
}

SheetCell::SheetCell(const SurfaceCell& cell, const SurfaceBasis& basis)
    : row_(basis.row(cell.centre_mm, cell.normal)), area_mm2_(cell.area_mm2) {
  for (std::size_t k = 0; k < 3; ++k)
    second_[k] = row_.combine(BasisRow::kD11 + static_cast<int>(k), basis.nodes().points_mm);
}

Eigen::Vector3d SheetCell::mid_strain(const std::vector<Eigen::Vector3d>& shift_mm,
                                      double thickness_mm) const {
  const LocalShape shape = local_shape(row_, shift_mm);
  const std::array<Eigen::Vector3d, 2> f = {shape.f1, shape.f2};
  Eigen::Vector3d strain;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [a, b] = kPairs[k];
    const Eigen::Vector3d bent = second_[k] + row_.combine(BasisRow::kD11 + static_cast<int>(k), shift_mm);
    strain[static_cast<Eigen::Index>(k)] =
        0.5 * (f[static_cast<std::size_t>(a)].dot(f[static_cast<std::size_t>(b)]) - (a == b ? 1.0 : 0.0)) +
        0.5 * thickness_mm * (shape.normal.dot(bent) - row_.normal.dot(second_[k]));
  }
  return strain;
}

SheetCell::Terms SheetCell::terms(const std::vector<Eigen::Vector3d>& shift_mm,
                                  const SheetPrior& prior) const {
  const LocalShape shape = local_shape(row_, shift_mm);
  const std::array<Eigen::Vector3d, 2> f = {shape.f1, shape.f2};
  Eigen::Matrix2d metric;
  metric << f[0].dot(f[0]), f[0].dot(f[1]), f[0].dot(f[1]), f[1].dot(f[1]);
  const Eigen::Matrix2d inverse = metric.inverse();
  const std::array<Eigen::Vector3d, 2> dual = {inverse(0, 0) * f[0] + inverse(0, 1) * f[1],
                                               inverse(1, 0) * f[0] + inverse(1, 1) * f[1]};
  const double share = area_mm2_ / (prior.patch_mm * prior.patch_mm);
  const double half_mm = 0.5 * prior.thickness_mm;
  const double bend_per_mm = seen_ ? prior.bend_per_mm : prior.unseen_bend_per_mm;
  const Eigen::Vector3d common = in_frame(prior.common_bend_per_mm, row_);
  Terms of;
  of.derivative.resize(row_.node.size());
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = static_cast<std::size_t>(kPairs[k][0]), b = static_cast<std::size_t>(kPairs[k][1]);
    const auto strain = static_cast<Eigen::Index>(k), bend = static_cast<Eigen::Index>(k + 3);
    const int second = BasisRow::kD11 + static_cast<int>(k);
    const Eigen::Vector3d bent = second_[k] + row_.combine(second, shift_mm);
    of.residual[bend] = shape.normal.dot(bent) - row_.normal.dot(second_[k]);
    of.residual[strain] = 0.5 * (f[a].dot(f[b]) - (a == b ? 1.0 : 0.0)) + half_mm * of.residual[bend];
    const double gamma1 = dual[0].dot(bent), gamma2 = dual[1].dot(bent);
    for (std::size_t j = 0; j < row_.node.size(); ++j) {
      const BasisRow::Weights& w = row_.weight[j];
      const double d[2] = {w[BasisRow::kD1], w[BasisRow::kD2]};
      of.derivative[j].col(bend) = (w[second] - gamma1 * d[0] - gamma2 * d[1]) * shape.normal;
      of.derivative[j].col(strain) = 0.5 * (d[a] * f[b] + d[b] * f[a]) + half_mm * of.derivative[j].col(bend);
    }
    of.residual[bend] -= common[static_cast<Eigen::Index>(k)];
    of.weight[strain] = kMultiplicity[k] * share / (prior.strain_ratio * prior.strain_ratio);
    of.weight[bend] = kMultiplicity[k] * share / (bend_per_mm * bend_per_mm);
  }
  return of;
}

void SheetCell::add(const std::vector<Eigen::Vector3d>& shift_mm, const SheetPrior& prior,
                    SurfaceSystem& system) const {
  const Terms of = terms(shift_mm, prior);
  system.add(row_.node, of.derivative, of.weight.cwiseProduct(of.residual), of.weight);
}

}  // namespace arris
