#include "acquisition/geometry/normals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr std::size_t kChunk = 1024;
constexpr double kSigmaPerMad = 1.4826;  // standard deviation over median absolute value of a normal variable

struct LocalPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double spacing_mm = 0.0;
  double residual_mm =
      -1.0;  // |distance to the plane|, scaled to the noise of one point; < 0: none left over
};

// Share of a point's own noise that its own plane absorbs (the hat value of the least-squares plane).
double leverage(const Eigen::Vector3d& offset_mm,
                const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>& solver, double count) {
  double hat = 1.0 / count;
  for (int axis = 1; axis < 3; ++axis) {
    const double along_mm = solver.eigenvectors().col(axis).dot(offset_mm);
    if (solver.eigenvalues()(axis) > 0.0) hat += along_mm * along_mm / (count * solver.eigenvalues()(axis));
  }
  return hat;
}

// `found` is the point itself and its neighbours, nearest first.
LocalPlane fit_plane(std::span<const Eigen::Vector3d> points_mm, const Eigen::Vector3d& point_mm,
                     const std::vector<Neighbour>& found) {
  LocalPlane plane;
  const std::size_t others = found.size() - 1;
  if (others > 0)
    plane.spacing_mm = std::sqrt(std::numbers::pi * found.back().distance2_mm2 / static_cast<double>(others));
  if (found.size() < 3) return plane;

  const auto count = static_cast<double>(found.size());
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();  // about the point, so that nothing large is squared
  for (const Neighbour& n : found) mean_mm += points_mm[static_cast<std::size_t>(n.index)] - point_mm;
  mean_mm /= count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Neighbour& n : found) {
    const Eigen::Vector3d d_mm = points_mm[static_cast<std::size_t>(n.index)] - point_mm - mean_mm;
    covariance += d_mm * d_mm.transpose();
  }
  covariance /= count;

  // The iterative solver: computeDirect() takes cosines, whose last bit depends on the CPU's instructions.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  plane.normal = solver.eigenvectors().col(0).normalized();
  const double left_over = 1.0 - leverage(-mean_mm, solver, count);
  if (found.size() > 3 && left_over > 0.05)
    plane.residual_mm = std::abs(plane.normal.dot(mean_mm)) / std::sqrt(left_over);
  return plane;
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LocalPlanes fit_local_planes(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree, int k,
                             int threads) {
  if (k < 3) throw Error(Fault::kBug, "fit_local_planes: k = " + std::to_string(k) + ", need >= 3");
  if (tree.size() != points_mm.size())
    throw Error(Fault::kBug, "fit_local_planes: the tree holds " + std::to_string(tree.size()) +
                                 " points, not " + std::to_string(points_mm.size()));
  LocalPlanes planes;
  planes.normals.resize(points_mm.size());
  planes.spacing_mm.resize(points_mm.size());
  std::vector<double> residuals_mm(points_mm.size());
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points_mm[i], k + 1, found);
      const LocalPlane plane = fit_plane(points_mm, points_mm[i], found);
      planes.normals[i] = plane.normal;
      planes.spacing_mm[i] = plane.spacing_mm;
      residuals_mm[i] = plane.residual_mm;
    }
  });
  std::erase_if(residuals_mm, [](double residual_mm) { return residual_mm < 0.0; });
  planes.noise_sigma_mm = kSigmaPerMad * median(residuals_mm);
  std::vector<double> spacings_mm = planes.spacing_mm;
  planes.spacing_median_mm = median(spacings_mm);
  return planes;
}

void orient_towards(std::span<const Eigen::Vector3d> points_mm, const Eigen::Vector3d& seen_from_mm,
                    std::vector<Eigen::Vector3d>& normals) {
  if (normals.size() != points_mm.size())
    throw Error(Fault::kBug, "orient_towards: " + std::to_string(normals.size()) + " normals for " +
                                 std::to_string(points_mm.size()) + " points");
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (normals[i].dot(seen_from_mm - points_mm[i]) < 0.0) normals[i] = -normals[i];
}

}  // namespace arris
