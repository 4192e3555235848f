#include "registration/common_bend.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "registration/bend_evidence.hpp"
#include "registration/surface_factor.hpp"
#include "registration/symmetric_modes.hpp"
#include "tests/registration/sheet_plate.hpp"

namespace arris {
namespace {

struct Plate : scenes::SheetPlate {
  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(3 * unmoved.size()); }
  /// Laid over a cylinder whose axis is at right angles to `across`.
  std::vector<Eigen::Vector3d> bent(const Eigen::Vector3d& across, double bend_per_mm) const {
    std::vector<Eigen::Vector3d> shift_mm;
    for (const Eigen::Vector3d& p : ground.basis->nodes().points_mm)
      shift_mm.emplace_back(0.0, 0.0, 0.5 * bend_per_mm * std::pow(across.dot(p), 2));
    return shift_mm;
  }
};

TEST(SymmetricModes, AreOrthonormal) {
  for (std::size_t a = 0; a < symmetric_modes().size(); ++a)
    for (std::size_t b = 0; b < symmetric_modes().size(); ++b)
      EXPECT_NEAR(symmetric_modes()[a].cwiseProduct(symmetric_modes()[b]).sum(), a == b ? 1.0 : 0.0, 1e-15);
}

TEST(CommonBend, OfAPlateLaidOverACylinderIsTheCylinders) {
  const Plate plate;
  const Eigen::Vector3d across(0.6, 0.8, 0.0);
  const double bend_per_mm = 2e-4;
  const CommonBend common =
      common_bend(plate.ground.sheet, plate.bent(across, bend_per_mm), plate.prior, plate.unknowns());
  const Eigen::Matrix3d wanted = bend_per_mm * across * across.transpose();
  EXPECT_LT((common.likeliest_per_mm() - wanted).norm(), 0.02 * bend_per_mm);
}

TEST(CommonBend, DoesNotPullAPlateLaidOverACylinderBack) {
  const Plate plate;
  const std::vector<Eigen::Vector3d> shift_mm = plate.bent(Eigen::Vector3d(0.6, 0.8, 0.0), 2e-4);
  SheetPrior bends = plate.prior;
  bends.strain_ratio = 1e9;
  const Eigen::VectorXd pulled = plate.priors(shift_mm, bends).gradient;
  bends.common_bend_per_mm =
      common_bend(plate.ground.sheet, shift_mm, bends, plate.unknowns()).likeliest_per_mm();
  EXPECT_LT(plate.priors(shift_mm, bends).gradient.norm(), 0.03 * pulled.norm());
}

/// Law: what takes six unknowns out is what solving for them as well leaves of the others.
TEST(CommonBend, IsTakenOutAsIfItHadBeenSolvedFor) {
  const Plate plate;
  const Eigen::Index n = plate.unknowns();
  Eigen::MatrixXd joint = Eigen::MatrixXd::Identity(n + 6, n + 6) * 1e-3;
  joint.bottomRightCorner<6, 6>() = 1e6 * Eigen::Matrix<double, 6, 6>::Identity();  // a radius of a metre
  for (const SheetCell& cell : plate.ground.sheet) {
    const SheetCell::Terms of = cell.terms(plate.unmoved, plate.prior);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, n + 6);
    for (std::size_t j = 0; j < of.derivative.size(); ++j)
      rows.middleCols<3>(3 * cell.row().node[j]) = of.derivative[j].transpose();
    for (std::size_t mode = 0; mode < 6; ++mode)
      rows.col(n + static_cast<Eigen::Index>(mode)).tail<3>() =
          -in_frame(symmetric_modes()[mode], cell.row());
    joint += rows.transpose() * of.weight.asDiagonal() * rows;
  }
  SurfaceSystem system = plate.priors(plate.unmoved, plate.prior);
  system.add_to_nodes(1e-3);
  common_bend(plate.ground.sheet, plate.unmoved, plate.prior, n).take_out_of(system);
  const Eigen::MatrixXd wanted = joint.inverse().topLeftCorner(n, n);
  EXPECT_LT((SurfaceFactor(system).inverse(1) - wanted).norm(), 1e-6 * wanted.norm());
}

/// A plate whose bends scatter by `ratio` of what is expected about a common one, its height seen at every
/// node.
FitParts drawn(const Plate& plate, double ratio, std::uint64_t seed) {
  constexpr double kSeenSigmaMm = 0.01;
  synthetic::Random random(seed);
  SheetPrior bends = plate.prior, others = plate.prior;
  bends.strain_ratio = others.bend_per_mm = 1e9;
  FitParts parts{SurfaceSystem(plate.ground.basis->band(), 0), plate.priors(plate.unmoved, others),
                 plate.priors(plate.unmoved, bends),
                 common_bend(plate.ground.sheet, plate.unmoved, bends, plate.unknowns())};
  parts.other_priors.add_to_nodes(1e-2);
  SurfaceSystem prior = parts.other_priors;
  prior.add(parts.bends, 1.0 / (ratio * ratio));
  Eigen::VectorXd normal(plate.unknowns());
  for (double& x : normal) x = random.normal();
  const Eigen::LLT<Eigen::MatrixXd> root(prior.dense());
  const Eigen::VectorXd field_mm = root.matrixU().solve(normal);
  const std::vector<Eigen::Vector3d> common_mm = plate.bent(Eigen::Vector3d(0.8, -0.6, 0.0), 3e-4);
  for (std::size_t j = 0; j < plate.unmoved.size(); ++j) {
    const Eigen::Index z = static_cast<Eigen::Index>(3 * j + 2);
    const double seen_mm = field_mm[z] + common_mm[j].z() + kSeenSigmaMm * random.normal(),
                 precision = 1.0 / (kSeenSigmaMm * kSeenSigmaMm);
    parts.data.block(j, j)(2, 2) += precision;
    parts.data.gradient[z] -= precision * seen_mm;
  }
  return parts;
}

TEST(BendEvidence, FindsHowFarTheBendsOfAPlateScatterAboutTheirCommonOne) {
  const Plate plate;
  for (const double ratio : {1.0, 0.3, 0.1}) {
    double log_sum = 0.0;
    constexpr std::uint64_t kPlates = 10;
    for (std::uint64_t seed = 0; seed < kPlates; ++seed) {
      const double found = likeliest_scatter_ratio(drawn(plate, ratio, seed));
      EXPECT_LT(std::abs(std::log(found / ratio)), std::log(2.3)) << ratio << " seed " << seed;
      log_sum += std::log(found / ratio);
    }
    EXPECT_LT(std::abs(log_sum / kPlates), std::log(1.35)) << ratio;
  }
}

TEST(BendEvidence, OfAPlateThatBendsAsItsCommonBendIsNext) {
  const Plate plate;
  EXPECT_LT(likeliest_scatter_ratio(drawn(plate, 1e-3, 7)), 0.03);
}

}  // namespace
}  // namespace arris
