#include "registration/edge_claims.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <span>

#include "fixtures/synthetic/random.hpp"

namespace arris {
namespace {

using Row = SurfaceSystem::Row;

/// Quadratic costs s_i (J_i x) + c_i (J_i x)^2 / 2 around x = 0, the minimum of all of them together with a
/// prior: what is let go can be worked out by solving again.
struct Quadratics {
  std::vector<std::int32_t> nodes{0, 1, 2};
  std::vector<EdgeClaim> claims;
  SurfaceSystem all{std::make_shared<NodeBand>(NodeBand::full(3)), 1};

  explicit Quadratics(std::uint64_t seed, const std::vector<double>& slopes) {
    synthetic::Random random(seed);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      EdgeClaim claim;
      claim.pair = 10 + i;
      claim.arc_mm = 10.0 * static_cast<double>(i);
      claim.row.node = &nodes;
      for (int k = 0; k < 3; ++k)
        claim.row.direction.push_back(
            Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
      claim.row.offset = 0;
      claim.row.offset_derivative = -1.0;
      claim.slope = slopes[i];
      claim.curvature = random.uniform(0.1, 2.0);
      claims.push_back(claim);
    }
    add_prior();
    for (const EdgeClaim& claim : claims) all.add(claim.row, 0.0, claim.curvature);
  }

  void add_prior() {
    all.add_to_nodes(3.0);
    all.add_to_offset(0, 3.0);
  }
  [[nodiscard]] Eigen::MatrixXd full() const { return all.dense(); }

  /// Where the rest has its minimum, and how much lower that is, when some claims are let go.
  [[nodiscard]] std::pair<Eigen::VectorXd, double> solved_without(
      const std::vector<std::size_t>& gone) const {
    Eigen::MatrixXd information = full();
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(information.rows());
    for (const std::size_t i : gone) {
      Eigen::VectorXd j = Eigen::VectorXd::Zero(information.rows());
      for (int k = 0; k < 3; ++k) j.segment<3>(3 * k) = claims[i].row.direction[static_cast<std::size_t>(k)];
      j[9] = claims[i].row.offset_derivative;
      information -= claims[i].curvature * j * j.transpose();
      pull += claims[i].slope * j;
    }
    const Eigen::VectorXd move = information.fullPivLu().solve(pull);
    return {move, 0.5 * pull.dot(move)};
  }
};

TEST(EdgeClaims, AreStraysWhereTheRestGainsMoreThanStraysCost) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Quadratics fit(seed, {-3.0});
    const Eigen::MatrixXd inverse = fit.full().inverse();
    const double gain = fit.solved_without({0}).second;
    for (const double ratio : {0.999, 1.001}) {
      fit.claims[0].saved = -ratio * gain;
      const ClaimVerdict verdict = judge_claims(fit.all, inverse, fit.claims, 50.0);
      if (ratio > 1.0)
        EXPECT_TRUE(verdict.strays.empty()) << seed;
      else
        EXPECT_EQ(verdict.strays, std::vector<std::size_t>{10}) << seed;
    }
  }
}

TEST(EdgeClaims, ADoubtIsTheMoveByItsOdds) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Quadratics fit(seed, {-3.0});
    const auto [move, gain] = fit.solved_without({0});
    fit.claims[0].saved = -gain - 1.0;  // odds 1 : e
    const ClaimVerdict verdict = judge_claims(fit.all, fit.full().inverse(), fit.claims, 50.0);
    ASSERT_TRUE(verdict.strays.empty());
    const Eigen::MatrixXd expected = 1.0 / (1.0 + std::exp(1.0)) * move * move.transpose();
    EXPECT_LT((verdict.doubt - expected).norm(), 1e-6 * expected.norm()) << seed;
  }
}

TEST(EdgeClaims, TwoThatHoldAnEdgeTogetherAreJudgedTogether) {
  int judged = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Quadratics fit(seed, {-3.0, -3.0});
    for (int k = 0; k < 3; ++k)  // both at the same place
      fit.claims[1].row.direction[static_cast<std::size_t>(k)] =
          fit.claims[0].row.direction[static_cast<std::size_t>(k)];
    fit.all = SurfaceSystem(fit.all.band, 1);
    fit.add_prior();
    for (EdgeClaim& claim : fit.claims) {
      claim.curvature = 2.0;
      fit.all.add(claim.row, 0.0, claim.curvature);
    }
    const double alone = fit.solved_without({0}).second, both = fit.solved_without({0, 1}).second;
    if (both < 2.5 * alone) continue;
    ++judged;
    fit.claims[0].saved = fit.claims[1].saved = -0.499 * both;  // neither alone, but both
    const Eigen::MatrixXd inverse = fit.full().inverse();
    EXPECT_EQ(judge_claims(fit.all, inverse, fit.claims, 50.0).strays.size(), 2u) << seed;
    EXPECT_TRUE(judge_claims(fit.all, inverse, fit.claims, 5.0).strays.empty()) << "too far apart, " << seed;
  }
  EXPECT_GT(judged, 5);
}

TEST(EdgeClaims, TheEdgeGoesNoFartherThanTheOthersLetIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Quadratics fit(seed, {-3.0});
    const auto [move, gain] = fit.solved_without({0});
    fit.claims[0].saved = -gain - 1.0;
    const Eigen::MatrixXd inverse = fit.full().inverse();
    const double length = move.norm();
    const auto wall = [&](const Eigen::VectorXd& moved, std::span<const std::size_t> without) {
      EXPECT_EQ(std::vector<std::size_t>(without.begin(), without.end()), std::vector<std::size_t>{0});
      return moved.norm() > 0.41 * length ? 1e9 : 0.0;
    };
    const ClaimVerdict verdict = judge_claims(fit.all, inverse, fit.claims, 50.0, wall);
    const double met = fit.claims[0].saved + gain * (2.0 - 0.4) * 0.4, odds = std::exp(met);
    const Eigen::MatrixXd expected = odds / (1.0 + odds) * 0.16 * move * move.transpose();
    EXPECT_LT((verdict.doubt - expected).norm(), 1e-6 * expected.norm()) << seed;
    const auto free = [](const Eigen::VectorXd&, std::span<const std::size_t>) { return 0.0; };
    EXPECT_TRUE(judge_claims(fit.all, inverse, fit.claims, 50.0, free)
                    .doubt.isApprox(judge_claims(fit.all, inverse, fit.claims, 50.0).doubt));
  }
}

}  // namespace
}  // namespace arris
