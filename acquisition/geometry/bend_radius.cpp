#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr double kStraight_mm = 1e9;

// Taubin's circle through points of a plane, by Newton steps from zero on the characteristic cubic (Chernov,
// Circular and Linear Regression, 2010, section 5.8). Unlike the plain algebraic fit it does not shrink short
// noisy arcs.
//   xy   points about their mean, in units of the window, so that the cubic is of order one
//   returns the radius in the same unit; infinite when the points are straight
double taubin_radius(const std::vector<Eigen::Vector2d>& xy) {
  double xx = 0.0, yy = 0.0, xy_mean = 0.0, xz = 0.0, yz = 0.0, zz = 0.0;
  for (const Eigen::Vector2d& p : xy) {
    const double z = p.squaredNorm();
    xx += p.x() * p.x();
    yy += p.y() * p.y();
    xy_mean += p.x() * p.y();
    xz += p.x() * z;
    yz += p.y() * z;
    zz += z * z;
  }
  const auto count = static_cast<double>(xy.size());
  for (double* moment : {&xx, &yy, &xy_mean, &xz, &yz, &zz}) *moment /= count;

  const double z_mean = xx + yy;
  const double det_xy = xx * yy - xy_mean * xy_mean;
  const double z_var = zz - z_mean * z_mean;
  const double a3 = 4.0 * z_mean;
  const double a2 = -3.0 * z_mean * z_mean - zz;
  const double a1 = z_var * z_mean + 4.0 * det_xy * z_mean - xz * xz - yz * yz;
  const double a0 = xz * (xz * yy - yz * xy_mean) + yz * (yz * xx - xz * xy_mean) - z_var * det_xy;
  double root = 0.0;
  double value = a0;
  for (int step = 0; step < 50; ++step) {
    const double next = root - value / (a1 + root * (2.0 * a2 + 3.0 * a3 * root));
    const double next_value = a0 + next * (a1 + next * (a2 + next * a3));
    if (!std::isfinite(next) || !(std::abs(next_value) < std::abs(value))) break;
    root = next;
    value = next_value;
  }
  const double det = root * root - root * z_mean + det_xy;
  const Eigen::Vector2d centre(xz * (yy - root) - yz * xy_mean, yz * (xx - root) - xz * xy_mean);
  return std::sqrt(centre.squaredNorm() / (4.0 * det * det) + z_mean);
}

double circle_radius_mm(std::vector<Eigen::Vector3d> points_mm, double scale_mm) {
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p_mm : points_mm) mean_mm += p_mm;
  mean_mm /= static_cast<double>(points_mm.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (Eigen::Vector3d& p_mm : points_mm) {
    p_mm = (p_mm - mean_mm) / scale_mm;
    covariance += p_mm * p_mm.transpose();
  }
  // The plane of bending: the run of the curve, and the direction of its largest sag.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  std::vector<Eigen::Vector2d> xy;
  for (const Eigen::Vector3d& p : points_mm)
    xy.emplace_back(solver.eigenvectors().col(2).dot(p), solver.eigenvectors().col(1).dot(p));
  const double radius_mm = taubin_radius(xy) * scale_mm;
  return std::isfinite(radius_mm) ? std::min(radius_mm, kStraight_mm) : kStraight_mm;
}

// The contour's points within the window of point i. A side that holds fewer than two of them (a long chord
// begins there) is represented by points of the chord itself, so that a corner between long chords is seen.
std::vector<Eigen::Vector3d> window_points_mm(const Curve& curve, int i, double window_mm) {
  const auto& all_mm = curve.contour().points_mm;
  const int count = static_cast<int>(all_mm.size());
  const double here_mm = curve.arc_of_point_mm(i);
  std::vector<Eigen::Vector3d> window{all_mm[static_cast<std::size_t>(i)]};
  for (const int side : {-1, 1}) {
    int taken = 0;
    for (int j = i + side; taken < count; j += side) {
      if (!curve.closed() && (j < 0 || j >= count)) break;
      const int point = (j + count) % count;
      const double away_mm = side * curve.arc_between_mm(here_mm, curve.arc_of_point_mm(point));
      if (point == i || away_mm < 0.0 || away_mm > window_mm) break;
      window.push_back(all_mm[static_cast<std::size_t>(point)]);
      ++taken;
    }
    if (taken >= 2) continue;
    for (const double part : {0.25, 0.5, 1.0}) {
      const double arc_mm = here_mm + side * part * window_mm;
      if (curve.closed() || (arc_mm >= 0.0 && arc_mm <= curve.length_mm()))
        window.push_back(curve.point_mm(arc_mm));
    }
  }
  return window;
}

}  // namespace

std::vector<double> bend_radius_mm(const Contour& contour, double window_mm) {
  if (!(window_mm > 0.0))
    throw Error(Fault::kBug, "bend_radius_mm: window_mm = " + std::to_string(window_mm) + ", need > 0");
  const Curve curve(contour);
  const double half_mm = curve.closed() ? std::min(window_mm, 0.5 * curve.length_mm()) : window_mm;
  std::vector<double> radii_mm;
  for (int i = 0; i < static_cast<int>(contour.points_mm.size()); ++i) {
    std::vector<Eigen::Vector3d> window = window_points_mm(curve, i, half_mm);
    radii_mm.push_back(window.size() < 3 ? kStraight_mm : circle_radius_mm(std::move(window), half_mm));
  }
  return radii_mm;
}

}  // namespace arris
