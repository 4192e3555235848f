#include "registration/edge_pairs.hpp"

namespace arris {

EdgePair pair_edge(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm) {
  EdgePair pair;
  pair.foot.distance_mm = reach_mm;
  for (std::size_t c = 0; c < cad.contours.size(); ++c) {
    const CurveFoot foot = cad.contours[c].nearest(p_cad_mm);
    if (foot.distance_mm >= pair.foot.distance_mm) continue;
    pair.contour = static_cast<int>(c);
    pair.foot = foot;
  }
  if (pair.contour < 0) return pair;
  const Curve& curve = cad.contours[static_cast<std::size_t>(pair.contour)];
  pair.normal = curve.normal(pair.foot.arc_mm);
  pair.across = pair.normal.cross(curve.tangent(pair.foot.arc_mm)).normalized();
  const Eigen::Vector3d apart = p_cad_mm - pair.foot.foot_mm;
  pair.across_mm = apart.dot(pair.across);
  pair.normal_mm = apart.dot(pair.normal);
  return pair;
}

}  // namespace arris
