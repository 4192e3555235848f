#include "acquisition/geometry/rigid_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using Points = std::span<const Eigen::Vector3d>;

constexpr double kLineRatio = 1e-9;       // second principal spread over the first
constexpr double kRoundingRatio = 1e-14;  // spread that rounding alone makes, over the largest coordinate
constexpr double kUniqueRatio = 1e-12;    // gap between the two best rotations over the total spread

void check_sizes(Points from_mm, Points to_mm, std::span<const double> weights) {
  if (from_mm.size() != to_mm.size())
    throw Error(Fault::kBug, "fit_rigid: " + std::to_string(from_mm.size()) + " points onto " +
                                 std::to_string(to_mm.size()));
  if (!weights.empty() && weights.size() != from_mm.size())
    throw Error(Fault::kBug, "fit_rigid: " + std::to_string(weights.size()) + " weights for " +
                                 std::to_string(from_mm.size()) + " pairs");
  for (const double weight : weights)
    if (!(weight >= 0.0) || !std::isfinite(weight))
      throw Error(Fault::kBug, "fit_rigid: weight " + std::to_string(weight) + ", need >= 0");
}

// The pairs that carry weight, about their centroids; weights sum to one.
struct Centred {
  std::vector<Eigen::Vector3d> from_mm, to_mm;
  std::vector<double> weights;
  Eigen::Vector3d from_centre_mm = Eigen::Vector3d::Zero(), to_centre_mm = Eigen::Vector3d::Zero();
};

Centred centre(Points from_mm, Points to_mm, std::span<const double> weights) {
  Centred pairs;
  for (std::size_t i = 0; i < from_mm.size(); ++i) {
    const double weight = weights.empty() ? 1.0 : weights[i];
    if (weight == 0.0) continue;
    pairs.from_mm.push_back(from_mm[i]);
    pairs.to_mm.push_back(to_mm[i]);
    pairs.weights.push_back(weight);
  }
  const double total = std::accumulate(pairs.weights.begin(), pairs.weights.end(), 0.0);
  for (std::size_t i = 0; i < pairs.weights.size(); ++i) {
    pairs.weights[i] /= total;
    pairs.from_centre_mm += pairs.weights[i] * pairs.from_mm[i];
    pairs.to_centre_mm += pairs.weights[i] * pairs.to_mm[i];
  }
  for (Eigen::Vector3d& p_mm : pairs.from_mm) p_mm -= pairs.from_centre_mm;
  for (Eigen::Vector3d& p_mm : pairs.to_mm) p_mm -= pairs.to_centre_mm;
  return pairs;
}

// Why the rotation of these points is not determined, or nothing. The spread across the line is summed
// directly: the second eigenvalue of a covariance carries the rounding of the first, 1e-8 of its spread.
// Coordinates far from the origin carry rounding that is no spread either.
std::string line_reason(const std::vector<Eigen::Vector3d>& points_mm, const Eigen::Vector3d& centre_mm,
                        const std::vector<double>& weights) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points_mm.size(); ++i)
    covariance += weights[i] * points_mm[i] * points_mm[i].transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d along = solver.eigenvectors().col(2);
  double along_mm2 = 0.0;
  double across_mm2 = 0.0;
  for (std::size_t i = 0; i < points_mm.size(); ++i) {
    const double s_mm = along.dot(points_mm[i]);
    along_mm2 += weights[i] * s_mm * s_mm;
    across_mm2 += weights[i] * (points_mm[i] - s_mm * along).squaredNorm();
  }
  const double rounding_mm = kRoundingRatio * centre_mm.cwiseAbs().maxCoeff();
  if (!(std::sqrt(along_mm2) > rounding_mm)) return "the points coincide";
  if (std::sqrt(across_mm2) <= std::max(kLineRatio * std::sqrt(along_mm2), rounding_mm))
    return "the points lie on a line";
  return {};
}

// Horn's symmetric 4 x 4 matrix (p. 635), scalar part first.
Eigen::Matrix4d horn_matrix(const Centred& pairs) {
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.weights.size(); ++i)
    s += pairs.weights[i] * pairs.from_mm[i] * pairs.to_mm[i].transpose();
  const Eigen::Vector3d skew(s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
  Eigen::Matrix4d n;
  n(0, 0) = s.trace();
  n.block<3, 1>(1, 0) = skew;
  n.block<1, 3>(0, 1) = skew.transpose();
  n.block<3, 3>(1, 1) = s + s.transpose() - s.trace() * Eigen::Matrix3d::Identity();
  return n;
}

double weighted_rms_mm(const RigidMotion& to_from, Points from_mm, Points to_mm,
                       std::span<const double> weights) {
  double sum_mm2 = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < from_mm.size(); ++i) {
    const double weight = weights.empty() ? 1.0 : weights[i];
    if (weight == 0.0) continue;
    sum_mm2 += weight * (to_from * from_mm[i] - to_mm[i]).squaredNorm();
    total += weight;
  }
  return std::sqrt(sum_mm2 / total);
}

}  // namespace

RigidFit fit_rigid(Points from_mm, Points to_mm, std::span<const double> weights) {
  check_sizes(from_mm, to_mm, weights);
  RigidFit fit;
  const Centred pairs = centre(from_mm, to_mm, weights);
  if (pairs.weights.size() < 3) {
    fit.reason = std::to_string(pairs.weights.size()) + " pairs, 3 needed";
    return fit;
  }
  if (!pairs.from_centre_mm.allFinite() || !pairs.to_centre_mm.allFinite()) {
    fit.reason = "a point is not finite";
    return fit;
  }
  fit.reason = line_reason(pairs.from_mm, pairs.from_centre_mm, pairs.weights);
  if (fit.usable()) fit.reason = line_reason(pairs.to_mm, pairs.to_centre_mm, pairs.weights);
  if (!fit.usable()) return fit;

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(horn_matrix(pairs));
  const Eigen::Vector4d& values = solver.eigenvalues();
  if (values(3) - values(2) <= kUniqueRatio * values.cwiseAbs().maxCoeff()) {
    fit.reason = "several rotations fit equally well";
    return fit;
  }
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  fit.to_from.linear() = Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized().toRotationMatrix();
  fit.to_from.translation() = pairs.to_centre_mm - fit.to_from.linear() * pairs.from_centre_mm;
  fit.rms_mm = weighted_rms_mm(fit.to_from, from_mm, to_mm, weights);
  return fit;
}

}  // namespace arris
