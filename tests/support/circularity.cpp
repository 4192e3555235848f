#include "tests/support/circularity.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

constexpr int kMostCentres = 60, kMostExchanges = 400;
constexpr double kDone = 1e-12;

/// The profile about a centre, by ascending angle.
struct Polar {
  std::vector<double> angle_rad, radius_mm;
};

Polar about(std::span<const Eigen::Vector2d> profile_mm, const Eigen::Vector2d& centre_mm) {
  std::vector<std::size_t> order(profile_mm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto angle = [&](std::size_t i) {
    const Eigen::Vector2d d = profile_mm[i] - centre_mm;
    return std::atan2(d.y(), d.x());
  };
  std::vector<double> angles(profile_mm.size());
  for (std::size_t i = 0; i < angles.size(); ++i) angles[i] = angle(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
  Polar polar;
  for (const std::size_t i : order) {
    polar.angle_rad.push_back(angles[i]);
    polar.radius_mm.push_back((profile_mm[i] - centre_mm).norm());
  }
  return polar;
}

Eigen::Vector3d basis(double angle_rad) {
  return {1.0, std::cos(angle_rad), std::sin(angle_rad)};
}

/// Best r = a + b cos t + c sin t in the sense of the largest deviation.
Eigen::Vector3d best_limacon(const Polar& polar) {
  const std::size_t count = polar.angle_rad.size();
  std::array<std::size_t, 4> touching{};
  for (std::size_t k = 0; k < 4; ++k) touching[k] = k * count / 4;
  for (int exchange = 0; exchange < kMostExchanges; ++exchange) {
    Eigen::Matrix4d system;
    Eigen::Vector4d right;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      system.row(row) << basis(polar.angle_rad[touching[k]]).transpose(), (k % 2 == 0 ? 1.0 : -1.0);
      right[row] = polar.radius_mm[touching[k]];
    }
    const Eigen::Vector4d solution = system.fullPivLu().solve(right);
    const Eigen::Vector3d curve = solution.head<3>();
    const auto off = [&](std::size_t i) { return polar.radius_mm[i] - curve.dot(basis(polar.angle_rad[i])); };
    std::size_t worst = 0;
    for (std::size_t i = 1; i < count; ++i)
      if (std::abs(off(i)) > std::abs(off(worst))) worst = i;
    if (std::abs(off(worst)) <= std::abs(solution[3]) + kDone * curve[0]) return curve;
    // The four alternate, also across the seam: of the two beside the worst one, one deviates to its side.
    const auto after = static_cast<std::size_t>(std::lower_bound(touching.begin(), touching.end(), worst) -
                                                touching.begin());
    const std::size_t left = (after + 3) % 4, right_of = after % 4;
    const bool like_left = std::signbit(off(touching[left])) == std::signbit(off(worst));
    touching[like_left ? left : right_of] = worst;
    std::sort(touching.begin(), touching.end());
  }
  throw Error(Fault::kBug, "no circles touch this profile in turn: it does not go round its middle");
}

}  // namespace

MinimumZone minimum_zone(std::span<const Eigen::Vector2d> profile_mm) {
  if (profile_mm.size() < 4) throw Error(Fault::kBug, "a minimum zone needs four points");
  MinimumZone zone;
  for (const Eigen::Vector2d& p : profile_mm) zone.centre_mm += p / static_cast<double>(profile_mm.size());
  for (int round = 0; round < kMostCentres; ++round) {
    const Polar polar = about(profile_mm, zone.centre_mm);
    zone.inner_mm = *std::min_element(polar.radius_mm.begin(), polar.radius_mm.end());
    zone.outer_mm = *std::max_element(polar.radius_mm.begin(), polar.radius_mm.end());
    const Eigen::Vector3d curve = best_limacon(polar);
    if (curve.tail<2>().norm() <= 1e-10 * curve[0]) return zone;
    zone.centre_mm += curve.tail<2>();
  }
  throw Error(Fault::kBug, "the middle of this profile does not settle: it is far from round");
}

MinimumZone circularity(std::span<const Eigen::Vector3d> profile_mm) {
  Eigen::Vector3d middle_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : profile_mm) middle_mm += p / static_cast<double>(profile_mm.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : profile_mm) spread += (p - middle_mm) * (p - middle_mm).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);  // least spread first: the normal
  const Eigen::Matrix<double, 3, 2> plane = axes.eigenvectors().rightCols<2>();
  std::vector<Eigen::Vector2d> flat_mm;
  for (const Eigen::Vector3d& p : profile_mm) flat_mm.emplace_back(plane.transpose() * (p - middle_mm));
  return minimum_zone(flat_mm);
}

}  // namespace arris::bench
