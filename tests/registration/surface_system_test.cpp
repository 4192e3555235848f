#include "registration/surface_system.hpp"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fixtures/synthetic/random.hpp"
#include "registration/surface_factor.hpp"
#include "registration/surface_shape.hpp"
#include "tests/registration/scenes.hpp"

namespace arris {
namespace {

using synthetic::Random;

Eigen::Vector3d any(Random& random) {
  return {random.normal(), random.normal(), random.normal()};
}

/// Nodes on a ring about a hole, three abreast.
std::vector<Eigen::Vector3d> ring(std::size_t around) {
  std::vector<Eigen::Vector3d> points_mm;
  for (std::size_t i = 0; i < around; ++i)
    for (int abreast = 0; abreast < 3; ++abreast) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(around);
      const double radius_mm = 10.0 * static_cast<double>(around) / (2.0 * std::numbers::pi) + 10.0 * abreast;
      points_mm.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0.0);
    }
  return points_mm;
}

std::vector<Eigen::Vector3d> reordered(const std::vector<Eigen::Vector3d>& points_mm,
                                       const std::vector<std::size_t>& order) {
  std::vector<Eigen::Vector3d> result;
  for (const std::size_t i : order) result.push_back(points_mm[i]);
  return result;
}

std::vector<double> all_reach(const std::vector<Eigen::Vector3d>& points_mm, double reach_mm) {
  return std::vector<double>(points_mm.size(), reach_mm);
}

TEST(NodeBand, HoldsAllThatAreNearAndIsNarrowWhateverTheOrderTheyCameIn) {
  std::vector<Eigen::Vector3d> shuffled = ring(40);
  Random random(7);
  for (std::size_t i = shuffled.size() - 1; i > 0; --i)
    std::swap(shuffled[i], shuffled[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)))]);
  std::vector<std::size_t> order = numbered_along(shuffled, all_reach(shuffled, 16.0));
  const std::vector<Eigen::Vector3d> points_mm = reordered(shuffled, order);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  std::vector<double> reach_mm;
  for (std::size_t a = 0; a < points_mm.size(); ++a) reach_mm.push_back(a % 2 == 0 ? 10.0 : 12.5);
  const NodeBand band = band_of(points_mm, reach_mm);
  std::size_t widest = 0;
  for (std::size_t a = 0; a < band.nodes(); ++a) {
    widest = std::max(widest, a - band.first(a));
    for (std::size_t b = 0; b < band.first(a); ++b)
      EXPECT_GE((points_mm[a] - points_mm[b]).norm(), reach_mm[a] + reach_mm[b]);
  }
  EXPECT_LE(widest, 24u);  // three abreast, both ways round, somewhat more than three rings: of 120
}

/// Rows of a few nodes near each other, added in each of the three ways; and what their products sum up to.
struct Sum {
  SurfaceSystem system;
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;

  explicit Sum(std::uint64_t seed)
      : system(std::make_shared<NodeBand>(band_of(in_order(), all_reach(in_order(), 12.5))), 2),
        information(Eigen::MatrixXd::Zero(system.gradient.size(), system.gradient.size())),
        gradient(Eigen::VectorXd::Zero(system.gradient.size())) {
    Random random(seed);
    const std::vector<Eigen::Vector3d> points_mm = in_order();
    for (std::size_t centre = 0; centre < points_mm.size(); ++centre) {
      std::vector<std::int32_t> node;
      for (std::size_t j = 0; j < points_mm.size(); ++j)
        if ((points_mm[j] - points_mm[centre]).norm() < 12.4) node.push_back(static_cast<std::int32_t>(j));
      add_row(node, static_cast<int>(centre % 2), random);
      add_along(node, random);
      add_together(node, random);
    }
    for (std::size_t e = 0; e < 2; ++e) system.add_to_offset(e, 0.5);
    system.add_to_nodes(0.01);
    information.diagonal().array() += 0.01;
    information.diagonal().tail(2).array() += 0.49;
  }

  static std::vector<Eigen::Vector3d> in_order() {
    const std::vector<Eigen::Vector3d> points_mm = ring(40);
    return reordered(points_mm, numbered_along(points_mm, all_reach(points_mm, 16.0)));
  }
  void expect(const Eigen::VectorXd& j, double slope, double curvature) {
    information += curvature * j * j.transpose();
    gradient += slope * j;
  }
  void add_row(const std::vector<std::int32_t>& node, int offset, Random& random) {
    SurfaceSystem::Row row{&node, {}, offset, random.normal()};
    for (std::size_t k = 0; k < node.size(); ++k) row.direction.push_back(any(random));
    const double slope = random.normal();
    system.add(row, slope, 2.0);
    Eigen::VectorXd j = Eigen::VectorXd::Zero(gradient.size());
    system.put(row, j);
    expect(j, slope, 2.0);
  }
  void add_along(const std::vector<std::int32_t>& node, Random& random) {
    const Eigen::Vector3d direction = any(random).normalized();
    std::vector<double> weight;
    Eigen::VectorXd j = Eigen::VectorXd::Zero(gradient.size());
    for (const std::int32_t n : node) {
      weight.push_back(random.normal());
      j.segment<3>(3 * n) = weight.back() * direction;
    }
    AlongSums sums(*system.band, 2);
    sums.add(node, weight, direction, 0.7, 3.0);
    system += sums;
    expect(j, 0.7, 3.0);
  }
  void add_together(const std::vector<std::int32_t>& node, Random& random) {
    std::vector<Eigen::Matrix<double, 3, SurfaceSystem::kTogether>> derivative(node.size());
    for (auto& d : derivative)
      for (int k = 0; k < SurfaceSystem::kTogether; ++k) d.col(k) = any(random);
    SurfaceSystem::Residuals slope, curvature;
    for (int k = 0; k < SurfaceSystem::kTogether; ++k) {
      slope[k] = random.normal();
      curvature[k] = random.uniform(0.1, 2.0);
    }
    system.add(node, derivative, slope, curvature);
    for (int k = 0; k < SurfaceSystem::kTogether; ++k) {
      Eigen::VectorXd j = Eigen::VectorXd::Zero(gradient.size());
      for (std::size_t a = 0; a < node.size(); ++a) j.segment<3>(3 * node[a]) = derivative[a].col(k);
      expect(j, slope[k], curvature[k]);
    }
  }
};

TEST(SurfaceSystem, IsTheSumOfItsRowsProductsHoweverTheyCome) {
  const Sum sum(1);
  EXPECT_LT((sum.system.dense() - sum.information).norm(), 1e-12 * sum.information.norm());
  EXPECT_LT((sum.system.gradient - sum.gradient).norm(), 1e-12 * sum.gradient.norm());
}

TEST(SurfaceFactor, SolvesAndInvertsAsADenseFactorDoes) {
  const Sum sum(2);
  const SurfaceFactor factor(sum.system);
  ASSERT_TRUE(factor.usable());
  const Eigen::LLT<Eigen::MatrixXd> dense(sum.information);
  const Eigen::VectorXd expected = dense.solve(sum.gradient);
  EXPECT_LT((factor.solve(sum.gradient) - expected).norm(), 1e-10 * expected.norm());
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(sum.information.rows(), sum.information.cols());
  const Eigen::MatrixXd inverse = dense.solve(identity);
  EXPECT_LT((factor.inverse(1) - inverse).norm(), 1e-10 * inverse.norm());
  EXPECT_LT((factor.spread(sum.information.leftCols(5)) - sum.information.topLeftCorner(5, 5)).norm(), 1e-9);
}

TEST(SurfaceFactor, OfASystemFromWhichColumnsAreTakenIsThatOfWhatIsLeft) {
  Sum sum(6);
  Random random(8);
  sum.system.taken = Eigen::MatrixXd(sum.gradient.size(), 3);
  for (double& x : sum.system.taken.reshaped()) x = 0.02 * random.normal();
  const Eigen::MatrixXd left = sum.information - sum.system.taken * sum.system.taken.transpose();
  EXPECT_LT((sum.system.dense() - left).norm(), 1e-12 * left.norm());
  const SurfaceFactor factor(sum.system);
  ASSERT_TRUE(factor.usable());
  const Eigen::LLT<Eigen::MatrixXd> dense(left);
  ASSERT_EQ(dense.info(), Eigen::Success);
  const Eigen::MatrixXd inverse = dense.solve(Eigen::MatrixXd::Identity(left.rows(), left.cols()));
  EXPECT_GT((inverse - Eigen::MatrixXd(sum.information.inverse())).norm(), 1e-3 * inverse.norm());
  EXPECT_LT((factor.solve(sum.gradient) - inverse * sum.gradient).norm(), 1e-9 * sum.gradient.norm());
  EXPECT_LT((factor.inverse(1) - inverse).norm(), 1e-9 * inverse.norm());
  EXPECT_LT((factor.spread(left.leftCols(5)) - left.topLeftCorner(5, 5)).norm(), 1e-8);
  EXPECT_NEAR(factor.log_determinant(), 2.0 * dense.matrixLLT().diagonal().array().log().sum(), 1e-8);
}

TEST(SurfaceFactor, SaysWhenMoreIsTakenThanThereIs) {
  Sum sum(6);
  sum.system.taken = Eigen::VectorXd::Constant(sum.gradient.size(), 1e3);
  EXPECT_FALSE(SurfaceFactor(sum.system).usable());
}

TEST(SurfaceSystem, AddsAnotherAsIfItWeighedMore) {
  Sum sum(7);
  const SurfaceSystem other = Sum(8).system;
  const Eigen::MatrixXd wanted = sum.information + 2.5 * other.dense();
  const Eigen::VectorXd gradient = sum.gradient + 2.5 * other.gradient;
  sum.system.add(other, 2.5);
  EXPECT_LT((sum.system.dense() - wanted).norm(), 1e-12 * wanted.norm());
  EXPECT_LT((sum.system.gradient - gradient).norm(), 1e-12 * gradient.norm());
}

TEST(SurfaceFactor, GivesTheSameBytesForAnyNumberOfThreads) {
  const SurfaceFactor factor(Sum(3).system);
  const Eigen::MatrixXd one = factor.inverse(1);
  EXPECT_TRUE(one == factor.inverse(2));
  EXPECT_TRUE(one == factor.inverse(8));
}

TEST(SurfaceFactor, SaysWhenThereIsNoResult) {
  Sum sum(4);
  sum.system.block(50, 50).diagonal().array() -= 1e6;
  EXPECT_FALSE(SurfaceFactor(sum.system).usable());
  sum.system.block(50, 50)(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SurfaceFactor(sum.system).usable());
  Sum offsets(5);
  offsets.system.add_to_offset(1, -1e6);
  EXPECT_FALSE(SurfaceFactor(offsets.system).usable());
}

/// Strain of the middle and change of curvature of a cell, each over what is expected, as Ceres sees them.
struct SheetResidual {
  const SheetCell* cell;
  const SheetPrior* prior;
  double area_mm2;
  bool operator()(double const* const* shift, double* residual) const {
    const std::vector<std::int32_t>& node = cell->row().node;
    std::vector<Eigen::Vector3d> shift_mm(static_cast<std::size_t>(node.back()) + 1, Eigen::Vector3d::Zero());
    for (std::size_t k = 0; k < node.size(); ++k)
      shift_mm[static_cast<std::size_t>(node[k])] = Eigen::Map<const Eigen::Vector3d>(shift[k]);
    const Eigen::Vector3d strain = cell->mid_strain(shift_mm, prior->thickness_mm);
    const Eigen::Vector3d bend = 2.0 / prior->thickness_mm * (strain - cell->mid_strain(shift_mm, 0.0));
    const double share = std::sqrt(area_mm2) / prior->patch_mm;
    for (int k = 0; k < 3; ++k) {
      const double twice = k == 1 ? std::sqrt(2.0) : 1.0;
      residual[k] = twice * share * strain[k] / prior->strain_ratio;
      residual[3 + k] = twice * share * bend[k] / prior->bend_per_mm;
    }
    return true;
  }
};

/// A place of the sheet seen in all three coordinates.
struct SeenPlace {
  const BasisRow* row;
  Eigen::Vector3d seen_mm;
  double sigma_mm;
  bool operator()(double const* const* shift, double* residual) const {
    Eigen::Map<Eigen::Vector3d> out(residual);
    out = -seen_mm;
    for (std::size_t k = 0; k < row->node.size(); ++k)
      out += row->weight[k][BasisRow::kValue] * Eigen::Map<const Eigen::Vector3d>(shift[k]);
    out /= sigma_mm;
    return true;
  }
};

/// Law: the field and covariance of our own normal equations are those that Ceres finds from the same
/// residuals by its own derivatives.
TEST(SurfaceSystem, FindsTheFieldAndTheCovarianceThatCeresFinds) {
  const CadModel cad = scenes::cad_of(synthetic::PlatePart(synthetic::plate_with_rounded_rectangle()));
  const std::vector<SurfaceCell> cells = thinned(band_cells(cad, 40.0, 16.0), 40.0, 1.0);
  const SurfaceBasis basis(place_nodes({&cad.contours[0]}, band_cells(cad, 40.0, 16.0), 40.0));
  SheetPrior prior;
  prior.thickness_mm = 3.0;
  std::vector<SheetCell> sheet;
  std::vector<SeenPlace> seen;
  Random random(11);
  for (const SurfaceCell& cell : cells) sheet.emplace_back(cell, basis);
  for (const SheetCell& cell : sheet) seen.push_back({&cell.row(), 0.5 * any(random), 0.2});

  std::vector<Eigen::Vector3d> ours(basis.size(), Eigen::Vector3d::Zero());
  const auto equations = [&] {
    SurfaceSystem system(basis.band(), 0);
    for (const SheetCell& cell : sheet) cell.add(ours, prior, system);
    AlongSums sums(*basis.band(), 0);
    for (const SeenPlace& place : seen)
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> weight;
        for (const BasisRow::Weights& w : place.row->weight) weight.push_back(w[BasisRow::kValue]);
        const double off_mm = (place.row->combine(BasisRow::kValue, ours) - place.seen_mm)[axis];
        const double precision = 1.0 / (place.sigma_mm * place.sigma_mm);
        sums.add(place.row->node, weight, Eigen::Vector3d::Unit(axis), precision * off_mm, precision);
      }
    system += sums;
    return system;
  };
  for (int round = 0; round < 30; ++round) {
    const SurfaceSystem system = equations();
    const Eigen::VectorXd move = -SurfaceFactor(system).solve(system.gradient);
    for (std::size_t j = 0; j < ours.size(); ++j)
      ours[j] += move.segment<3>(static_cast<Eigen::Index>(3 * j));
  }

  std::vector<Eigen::Vector3d> theirs(basis.size(), Eigen::Vector3d::Zero());
  ceres::Problem problem;
  const auto add = [&](auto* residual, int count, const std::vector<std::int32_t>& node) {
    using Residual = std::remove_pointer_t<decltype(residual)>;
    auto* cost = new ceres::DynamicNumericDiffCostFunction<Residual, ceres::CENTRAL>(residual);
    std::vector<double*> blocks;
    for (const std::int32_t j : node) {
      cost->AddParameterBlock(3);
      blocks.push_back(theirs[static_cast<std::size_t>(j)].data());
    }
    cost->SetNumResiduals(count);
    problem.AddResidualBlock(cost, nullptr, blocks);
  };
  for (std::size_t i = 0; i < sheet.size(); ++i)
    add(new SheetResidual{&sheet[i], &prior, cells[i].area_mm2}, 6, sheet[i].row().node);
  for (const SeenPlace& place : seen) add(new SeenPlace(place), 3, place.row->node);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.function_tolerance = options.parameter_tolerance = 1e-14;
  options.max_num_iterations = 100;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  for (std::size_t j = 0; j < ours.size(); ++j) EXPECT_LT((ours[j] - theirs[j]).norm(), 1e-5) << j;
  const Eigen::MatrixXd covariance = SurfaceFactor(equations()).inverse(1);
  ceres::Covariance::Options sparse;
  ceres::Covariance theirs_of(sparse);
  std::vector<std::pair<const double*, const double*>> pairs;
  for (const Eigen::Vector3d& shift : theirs) pairs.emplace_back(shift.data(), shift.data());
  ASSERT_TRUE(theirs_of.Compute(pairs, &problem));
  for (std::size_t j = 0; j < theirs.size(); ++j) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block;
    ASSERT_TRUE(theirs_of.GetCovarianceBlock(theirs[j].data(), theirs[j].data(), block.data()));
    const auto at = static_cast<Eigen::Index>(3 * j);
    EXPECT_LT((covariance.block<3, 3>(at, at) - block).norm(), 1e-3 * block.norm()) << j;
  }
}

}  // namespace
}  // namespace arris
