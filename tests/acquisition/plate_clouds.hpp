#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "acquisition/contour_extract.hpp"
#include "acquisition/types/frames.hpp"
#include "tests/geometry/random_points.hpp"

namespace arris::testing {

/// A rounded rectangle in the plane z = 0, with the distance to its edge in closed form; a circle when the
/// corner radius is both halves.
struct Rounded {
  Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();
  double half_x_mm = 30.0, half_y_mm = 30.0, corner_mm = 30.0;

  /// Negative inside.
  [[nodiscard]] double signed_mm(const Eigen::Vector3d& p_mm) const {
    const Eigen::Array2d half_mm(half_x_mm - corner_mm, half_y_mm - corner_mm);
    const Eigen::Array2d beyond_mm = (p_mm.head<2>() - centre_mm).array().abs() - half_mm;
    return beyond_mm.max(0.0).matrix().norm() + std::min(beyond_mm.maxCoeff(), 0.0) - corner_mm;
  }
  [[nodiscard]] double length_mm() const {
    return 4.0 * (half_x_mm + half_y_mm - 2.0 * corner_mm) + 2.0 * std::numbers::pi * corner_mm;
  }
};

[[nodiscard]] inline Rounded circle(double x_mm, double y_mm, double radius_mm) {
  return {{x_mm, y_mm}, radius_mm, radius_mm, radius_mm};
}

/// A flat plate, air on +z.
struct Plate {
  Rounded outline{Eigen::Vector2d::Zero(), 60.0, 60.0, 0.0};
  std::vector<Rounded> holes{circle(0.3, -0.4, 30.0)};

  [[nodiscard]] bool material_at(const Eigen::Vector3d& p_mm) const {
    return outline.signed_mm(p_mm) < 0.0 && std::all_of(holes.begin(), holes.end(), [&](const Rounded& hole) {
             return hole.signed_mm(p_mm) > 0.0;
           });
  }
};

/// How a scanner spreads its points; each kind has one point a mm^2. Rows: five times finer along them.
enum class Sampling { kGrid, kRandom, kRows };

[[nodiscard]] inline std::vector<Eigen::Vector3d> sampled(const Plate& plate, Sampling sampling,
                                                          unsigned seed = 1) {
  Random random(seed);
  const double x_mm = plate.outline.half_x_mm, y_mm = plate.outline.half_y_mm;
  std::vector<Eigen::Vector3d> points_mm;
  const auto keep = [&](double x, double y) {
    if (plate.material_at({x, y, 0.0})) points_mm.emplace_back(x, y, 0.0);
  };
  if (sampling == Sampling::kRandom) {
    for (int i = 0; i < static_cast<int>(4.0 * x_mm * y_mm); ++i) {
      const double x = random.uniform(-x_mm, x_mm);
      keep(x, random.uniform(-y_mm, y_mm));
    }
    return points_mm;
  }
  const double along_mm = sampling == Sampling::kRows ? 1.0 / std::sqrt(5.0) : 1.0;
  for (double y = -y_mm + 0.5 / along_mm; y < y_mm; y += 1.0 / along_mm) {
    const double shift_mm = sampling == Sampling::kRows ? random.uniform(0.0, along_mm) : 0.5;
    for (double x = -x_mm + shift_mm; x < x_mm; x += along_mm) keep(x, y);
  }
  return points_mm;
}

inline void add_noise(std::vector<Eigen::Vector3d>& points_mm, double sigma_mm, unsigned seed = 5) {
  Random random(seed);
  for (Eigen::Vector3d& p_mm : points_mm) p_mm.z() += sigma_mm * random.normal();
}

inline void move(std::vector<Eigen::Vector3d>& points_mm, const RigidMotion& motion) {
  for (Eigen::Vector3d& p_mm : points_mm) p_mm = motion * p_mm;
}

/// What the pipeline does with points: planes, normals towards the air side, contours.
[[nodiscard]] inline ContourSet contours_of(const std::vector<Eigen::Vector3d>& points_mm,
                                            const ContourOptions& options = {},
                                            const Eigen::Vector3d& seen_from_mm = {0.0, 0.0, 1e4}) {
  const NearestPoints tree(points_mm);
  LocalPlanes planes = fit_local_planes(points_mm, tree, 12, options.threads);
  orient_towards(points_mm, seen_from_mm, planes.normals);
  return cloud_contours(points_mm, tree, planes, options);
}

/// A found loop against the curve it shows.
struct LoopError {
  double mean_mm = 0.0, sd_mm = 0.0, worst_mm = 0.0;  ///< distance into the material; worst: either way
};

/// `void_is_inside`: the curve is a hole's, not an outline's.
[[nodiscard]] inline LoopError error_of_loop(const Contour& loop, const Rounded& curve, bool void_is_inside) {
  LoopError error;
  double sum2 = 0.0;
  for (const Eigen::Vector3d& p_mm : loop.points_mm) {
    const double inwards_mm = (void_is_inside ? 1.0 : -1.0) * curve.signed_mm(p_mm);
    error.mean_mm += inwards_mm;
    sum2 += inwards_mm * inwards_mm;
    error.worst_mm = std::max(error.worst_mm, std::abs(inwards_mm));
  }
  const auto count = static_cast<double>(loop.points_mm.size());
  error.mean_mm /= count;
  error.sd_mm = std::sqrt(std::max(0.0, sum2 / count - error.mean_mm * error.mean_mm));
  return error;
}

/// Share of the curve's length that has a loop point within reach_mm; 720 places of equal angle.
[[nodiscard]] inline double covered_ratio(const Contour& loop, const Rounded& curve, double reach_mm) {
  int covered = 0;
  for (int k = 0; k < 720; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 720.0;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d centre(curve.centre_mm.x(), curve.centre_mm.y(), 0.0);
    double low = 0.0, high = 2.0 * (curve.half_x_mm + curve.half_y_mm);
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (curve.signed_mm(centre + middle * direction) < 0.0 ? low : high) = middle;
    }
    const Eigen::Vector3d edge_mm = centre + low * direction;
    covered += std::any_of(loop.points_mm.begin(), loop.points_mm.end(),
                           [&](const Eigen::Vector3d& p_mm) { return (p_mm - edge_mm).norm() <= reach_mm; });
  }
  return covered / 720.0;
}

/// Twice the area that the loop encloses, signed: positive when it turns left about +z.
[[nodiscard]] inline double turn_mm2(const Contour& loop) {
  double sum = 0.0;
  for (std::size_t i = 0; i < loop.points_mm.size(); ++i) {
    const Eigen::Vector3d& a = loop.points_mm[i];
    const Eigen::Vector3d& b = loop.points_mm[(i + 1) % loop.points_mm.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

}  // namespace arris::testing
