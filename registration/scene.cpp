#include "registration/scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace arris {
namespace {

constexpr double kFanWindowMm = 6.0;

}  // namespace

Eigen::Vector3d inward_of(const Curve& contour, double arc_mm) {
  return contour.normal(arc_mm).cross(contour.tangent(arc_mm)).normalized();
}

double fan_per_mm(const Curve& contour, double arc_mm) {
  const double window_mm = std::min(kFanWindowMm, contour.length_mm() / 20.0);
  const Eigen::Vector3d before = contour.tangent(contour.wrap_mm(arc_mm - window_mm));
  const Eigen::Vector3d after = contour.tangent(contour.wrap_mm(arc_mm + window_mm));
  const Eigen::Vector3d inward = contour.normal(arc_mm).cross(contour.tangent(arc_mm));
  return -(after - before).dot(inward) / (2.0 * window_mm);
}

Eigen::Vector3d CadModel::inward(std::size_t c, double arc_mm) const {
  return inward_of(contours[c], arc_mm);
}

Eigen::Vector3d CadModel::smooth_normal(const SurfacePoint& foot) const {
  const auto& corners = mesh.triangles[static_cast<std::size_t>(foot.triangle)];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    normal +=
        foot.barycentric[static_cast<Eigen::Index>(k)] * vertex_normals[static_cast<std::size_t>(corners[k])];
  return normal.normalized();
}

NearestContour nearest_contour(std::span<const Curve> contours, const Eigen::Vector3d& p_mm) {
  NearestContour nearest;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    const CurveFoot foot = contours[i].nearest(p_mm);
    if (i == 0 || foot.distance_mm < nearest.foot.distance_mm) nearest = {i, foot};
  }
  return nearest;
}

}  // namespace arris
