#pragma once

#include <Eigen/Core>
#include <vector>

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

/// Nearest contour and the two components across the tangent; contour -1 beyond reach_mm. `hint`: an earlier
/// answer of a point that has moved a little; it makes the search quicker and changes nothing.
[[nodiscard]] EdgePair pair_edge(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm,
                                 const EdgePair& hint = {});

/// Whether a contour passes nearer than reach_mm: quicker than pair_edge().
[[nodiscard]] bool near_contours(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm);

/// Points of one scan loop, and whether the loop runs along an accepted contour.
struct LoopAssignment {
  int contour = -1;        ///< accepted contour that it follows; -1: dropped
  double median_mm = 0.0;  ///< median distance to the nearest contour at the pose given
};

/// Which scan loops run along an accepted CAD contour at a pose: the median distance within a tenth of the
/// contour's size and half the band, or so much of the loop near it as makes a third of the contour (a gap
/// joins it to the border of the scan). That border alone, clamps and other openings do not.
[[nodiscard]] std::vector<LoopAssignment> assign_loops(const CadModel& cad, const std::vector<Contour>& loops,
                                                       const RigidMotion& scan_from_cad, double band_mm);

}  // namespace arris
