#include "registration/edge_claims.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr double kLeastLever = 0.1;     // of a claim that may carry an edge together with another one
constexpr double kMostLever = 0.98;     // the bound on the curvature may exceed its true share
constexpr double kLeastLogOdds = -5.0;  // below them a doubt is none
constexpr int kMoveSteps = 10;

/// One or two claims to let go together.
struct Alternative {
  std::vector<std::size_t> claims;
  Eigen::VectorXd move;                 // of the unknowns, as factors of the claims' columns
  double saved = 0.0, quadratic = 0.0;  // by calling them strays; by the move, as the tangents have it
  double gain = 0.0;
};

class ClaimJudge {
 public:
  ClaimJudge(const SurfaceSystem& system, const Eigen::MatrixXd& inverse,
             const std::vector<EdgeClaim>& claims)
      : system_(system), claims_(claims) {
    for (const EdgeClaim& claim : claims) columns_.push_back(system.times(inverse, claim.row));
  }

  [[nodiscard]] double lever(std::size_t a) const {
    return claims_[a].curvature * system_.dot(claims_[a].row, columns_[a]);
  }

  [[nodiscard]] Alternative without(std::vector<std::size_t> claims) const {
    const auto n = static_cast<Eigen::Index>(claims.size());
    Alternative result;
    result.claims = std::move(claims);
    Eigen::MatrixXd spread(n, n);  // V
    Eigen::VectorXd slope(n), curvature(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const EdgeClaim& a = claims_[result.claims[static_cast<std::size_t>(i)]];
      slope[i] = a.slope;
      curvature[i] = a.curvature;
      result.saved += a.saved;
      for (Eigen::Index j = 0; j < n; ++j)
        spread(i, j) = system_.dot(a.row, columns_[result.claims[static_cast<std::size_t>(j)]]);
    }
    const Eigen::VectorXd root = curvature.cwiseSqrt();
    const Eigen::MatrixXd levers = root.asDiagonal() * spread * root.asDiagonal();
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(levers).eigenvalues()[n - 1];
    if (largest > kMostLever) curvature *= kMostLever / largest;
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(n, n) - curvature.asDiagonal() * spread;
    result.move = rest.partialPivLu().solve(slope);
    result.quadratic = 0.5 * slope.dot(spread * result.move);
    result.gain = result.saved + result.quadratic;
    return result;
  }

  /// Takes the alternative as far along its move as it pays.
  void meet(const EdgeResistance& resistance, Alternative& alternative) const {
    const Eigen::VectorXd whole = move_of(alternative);
    double best = 0.0, share = 0.0;
    for (int step = 1; step <= kMoveSteps; ++step) {
      const double t = static_cast<double>(step) / kMoveSteps;
      const double gain = alternative.quadratic * (2.0 - t) * t - resistance(t * whole, alternative.claims);
      if (gain > best) {
        best = gain;
        share = t;
      }
    }
    alternative.gain = alternative.saved + best;
    alternative.move *= share;
  }

  [[nodiscard]] Eigen::VectorXd move_of(const Alternative& alternative) const {
    Eigen::VectorXd move = Eigen::VectorXd::Zero(system_.gradient.size());
    for (std::size_t i = 0; i < alternative.claims.size(); ++i)
      move += alternative.move[static_cast<Eigen::Index>(i)] * columns_[alternative.claims[i]];
    return move;
  }

 private:
  const SurfaceSystem& system_;
  const std::vector<EdgeClaim>& claims_;
  std::vector<Eigen::VectorXd> columns_;
};

}  // namespace

ClaimVerdict judge_claims(const SurfaceSystem& system, const Eigen::MatrixXd& inverse,
                          const std::vector<EdgeClaim>& claims, double near_mm,
                          const EdgeResistance& resistance) {
  const ClaimJudge judge(system, inverse, claims);
  std::vector<Alternative> alternatives;
  std::vector<std::size_t> carrying;
  for (std::size_t a = 0; a < claims.size(); ++a) {
    alternatives.push_back(judge.without({a}));
    if (judge.lever(a) > kLeastLever) carrying.push_back(a);
  }
  for (const std::size_t a : carrying)
    for (const std::size_t b : carrying)
      if (a < b && claims[a].row.offset == claims[b].row.offset &&
          std::abs(claims[a].arc_mm - claims[b].arc_mm) < near_mm)
        alternatives.push_back(judge.without({a, b}));
  std::stable_sort(alternatives.begin(), alternatives.end(),
                   [](const Alternative& a, const Alternative& b) { return a.gain > b.gain; });
  ClaimVerdict verdict;
  verdict.doubt = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  std::vector<char> taken(claims.size(), 0);
  for (Alternative& alternative : alternatives) {
    if (alternative.gain < kLeastLogOdds) break;
    const auto& ids = alternative.claims;
    if (std::any_of(ids.begin(), ids.end(), [&](std::size_t a) { return taken[a] != 0; })) continue;
    for (const std::size_t a : ids) taken[a] = 1;
    if (alternative.gain > 0.0) {
      for (const std::size_t a : ids) verdict.strays.push_back(claims[a].pair);
      continue;
    }
    if (resistance) judge.meet(resistance, alternative);
    const Eigen::VectorXd move = judge.move_of(alternative);
    const double odds = std::exp(alternative.gain);
    verdict.doubt.noalias() += odds / (1.0 + odds) * move * move.transpose();
  }
  return verdict;
}

}  // namespace arris
