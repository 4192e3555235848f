#include "acquisition/types/point_cloud.hpp"

namespace arris {

std::vector<Eigen::Vector3d> local_points_mm(const PointCloud& cloud) {
  std::vector<Eigen::Vector3d> points(cloud.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = cloud.local_mm(i);
  return points;
}

}  // namespace arris
