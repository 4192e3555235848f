#include "registration/seen_elsewhere.hpp"

#include <Eigen/Eigenvalues>
#include <array>

#include "registration/carried_contour.hpp"
#include "registration/edge_strips.hpp"

namespace arris {
namespace {

constexpr double kElsewhereMm = 12.0, kWorthSeenRatio = 0.13;  // of the edges' length
constexpr int kElsewhereSteps = 6;
constexpr std::size_t kFewBeyond = 2;
constexpr double kBeliedSpacings = 2.0;

/// Length of the edges that the scan shows; a point beyond one, where it seems to be seen, belies some of it.
double shown_mm(const EdgeStrips& strips, std::size_t beyond, double spacing_mm) {
  return strips.seen_mm() - kBeliedSpacings * spacing_mm * static_cast<double>(beyond);
}

/// The two directions in which the contours extend most.
std::array<Eigen::Vector3d, 2> along_contours(const std::vector<std::vector<ContourStation>>& contours) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (const std::vector<ContourStation>& stations : contours)
    for (const ContourStation& station : stations) {
      mean += station.point_mm;
      spread += station.point_mm * station.point_mm.transpose();
      count += 1.0;
    }
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread / count - mean * mean.transpose());
  return {axes.eigenvectors().col(2), axes.eigenvectors().col(1)};
}

}  // namespace

SeenElsewhere seen_elsewhere(const EdgeStrips& strips,
                             const std::vector<std::vector<ContourStation>>& contours,
                             const std::vector<Eigen::Vector3d>& shift_mm, double spacing_mm,
                             const std::function<void(const std::vector<Eigen::Vector3d>&)>& lay) {
  lay(shift_mm);
  const double worth_mm = kWorthSeenRatio * strips.length_mm();
  const std::size_t beyond = strips.points_beyond();
  SeenElsewhere best;
  best.here_mm = shown_mm(strips, beyond, spacing_mm);
  if (strips.length_mm() - strips.seen_mm() < worth_mm) return best;
  double most_mm = best.here_mm + worth_mm;
  for (const Eigen::Vector3d& direction : along_contours(contours))
    for (int step = -kElsewhereSteps; step <= kElsewhereSteps; ++step) {
      std::vector<Eigen::Vector3d> moved = shift_mm;
      const Eigen::Vector3d by_mm = kElsewhereMm / kElsewhereSteps * step * direction;
      for (Eigen::Vector3d& shift : moved) shift += by_mm;
      lay(moved);
      const std::size_t beyond_now = strips.points_beyond();
      const double shown_now_mm = shown_mm(strips, beyond_now, spacing_mm);
      if (shown_now_mm <= most_mm || beyond_now > beyond + kFewBeyond) continue;
      most_mm = shown_now_mm;
      best.by_mm = by_mm;
    }
  return best;
}

}  // namespace arris
