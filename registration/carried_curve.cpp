#include "registration/carried_curve.hpp"

namespace arris {
namespace {

Contour carry(const ContourMotion& motion) {
  const Curve& nominal = motion.nominal();
  Contour carried = nominal.contour();
  for (std::size_t i = 0; i < carried.points_mm.size(); ++i) {
    const double s_mm = nominal.arc_of_point_mm(static_cast<int>(i));
    carried.points_mm[i] = motion.at(s_mm) * nominal.contour().points_mm[i];
  }
  return carried;
}

}  // namespace

CarriedCurve::CarriedCurve(const ContourMotion& motion) : nominal_(motion.nominal()), curve_(carry(motion)) {}

double CarriedCurve::arc_of(const Eigen::Vector3d& p_scan_mm, double& distance_mm) const {
  const CurveFoot foot = curve_.nearest(p_scan_mm);
  distance_mm = foot.distance_mm;
  return nominal_arc_mm(foot);
}

std::optional<double> CarriedCurve::arc_within(const Eigen::Vector3d& p_scan_mm, double reach_mm) const {
  const CurveFoot foot = curve_.nearest_within(p_scan_mm, reach_mm);
  if (foot.segment < 0) return std::nullopt;
  return nominal_arc_mm(foot);
}

double CarriedCurve::nominal_arc_mm(const CurveFoot& foot) const {
  const double begin = nominal_.arc_of_point_mm(foot.segment);
  const double end = nominal_.arc_of_point_mm(foot.segment + 1);  // the total length after the last chord
  return begin + foot.ratio * (end - begin);
}

}  // namespace arris
