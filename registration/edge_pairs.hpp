#pragma once

#include <Eigen/Core>

#include "registration/normal_equations.hpp"
#include "registration/scene.hpp"

namespace arris {

/// A scan edge point carried back to the CAD and its place on the nearest accepted contour.
struct EdgePair {
  int contour = -1;
  CurveFoot foot;
  Eigen::Vector3d across = Eigen::Vector3d::Zero();  ///< unit, in the surface, into the material, at the foot
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double across_mm = 0.0;  ///< signed, into the material
  double normal_mm = 0.0;  ///< signed, out of the material
};

/// Nearest contour and the two components across the tangent; contour -1 beyond reach_mm.
[[nodiscard]] EdgePair pair_edge(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm);

}  // namespace arris
