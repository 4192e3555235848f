#include "registration/scene.hpp"

#include <Eigen/Geometry>

namespace arris {

Eigen::Vector3d CadModel::inward(std::size_t c, double arc_mm) const {
  return contours[c].normal(arc_mm).cross(contours[c].tangent(arc_mm)).normalized();
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
