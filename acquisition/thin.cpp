#include "acquisition/thin.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "acquisition/clean.hpp"
#include "acquisition/geometry/evenly_drawn.hpp"

namespace arris {
namespace {

constexpr std::size_t kDrawnPerPoint = 10;      // a voxel that holds ten on average is hardly ever missed
constexpr double kFirstCellRatio = 1.0 / 64.0;  // of the box's diagonal
constexpr int kRounds = 3;

std::size_t occupied_cells(const PointCloud& cloud, double cell_mm) {
  std::vector<std::array<std::int64_t, 3>> cells(cloud.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      cells[i][axis] = static_cast<std::int64_t>(
          std::floor(static_cast<double>(cloud.points_mm[i][static_cast<int>(axis)]) / cell_mm));
  std::sort(cells.begin(), cells.end());
  return static_cast<std::size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

/// Edge of the voxels of which about `count` hold points of a surface: cells go with its square.
double cell_for(const PointCloud& cloud, std::size_t count) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : cloud.points_mm) box.extend(p);
  double cell_mm = kFirstCellRatio * static_cast<double>(box.diagonal().norm());
  for (int round = 0; round < kRounds && cell_mm > 0.0; ++round)
    cell_mm *= std::sqrt(static_cast<double>(occupied_cells(cloud, cell_mm)) / static_cast<double>(count));
  return cell_mm;
}

PointCloud drawn_from(const PointCloud& cloud, std::size_t count) {
  PointCloud drawn;
  drawn.offset_mm = cloud.offset_mm;
  for (const std::size_t i : evenly_drawn(cloud.size(), count)) {
    drawn.points_mm.push_back(cloud.points_mm[i]);
    if (cloud.has_normals()) drawn.normals.push_back(cloud.normals[i]);
  }
  return drawn;
}

}  // namespace

PointCloud thinned_to(const PointCloud& cloud, std::size_t points) {
  if (cloud.size() <= points || points == 0) return cloud;
  const PointCloud drawn = drawn_from(cloud, kDrawnPerPoint * points);
  CleanOptions options;
  options.outlier_sigmas = 0.0;
  options.voxel_mm = cell_for(drawn, points);
  return clean(drawn, options).cloud;
}

}  // namespace arris
