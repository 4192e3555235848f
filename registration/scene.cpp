#include "registration/scene.hpp"

#include <Eigen/Geometry>

namespace arris {

Eigen::Vector3d CadModel::inward(std::size_t c, double arc_mm) const {
  return contours[c].normal(arc_mm).cross(contours[c].tangent(arc_mm)).normalized();
}

}  // namespace arris
