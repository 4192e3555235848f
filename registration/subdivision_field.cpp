#include "registration/subdivision_field.hpp"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

/// Slope of the height along the contour, by a central difference of a quarter knot.
double height_slope(const EdgeFit& edge, const Curve& curve, double arc_mm) {
  const double step_mm = 0.25 * edge.spline.knot_mm();
  const double ahead = edge.spline.at(curve.wrap_mm(arc_mm + step_mm)).dot(edge.height);
  const double behind = edge.spline.at(curve.wrap_mm(arc_mm - step_mm)).dot(edge.height);
  return (ahead - behind) / (2.0 * step_mm);
}

Eigen::Matrix3d small_turn(const Eigen::Vector3d& rotation_vector) {
  const double angle_rad = rotation_vector.norm();
  if (angle_rad == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_rad, rotation_vector / angle_rad).toRotationMatrix();
}

}  // namespace

SubdivisionField::SubdivisionField(const CadModel& cad, std::vector<ContourResult> contours, double band_mm,
                                   bool follow_edge)
    : nominal_(cad.contours), contours_(std::move(contours)), band_mm_(band_mm), follow_edge_(follow_edge) {}

MappedPoint SubdivisionField::map(const Eigen::Vector3d& p_cad_mm) const {
  MappedPoint mapped;
  if (nominal_.empty()) return mapped;
  const auto [c, foot] = nearest_contour(nominal_, p_cad_mm);
  const Curve& curve = nominal_[c];
  const EdgeFit& edge = contours_[c].edge;
  const RigidMotion motion = contours_[c].motion.at(foot.arc_mm);
  const Eigen::Vector3d tangent = curve.tangent(foot.arc_mm), normal = curve.normal(foot.arc_mm);
  const Eigen::Vector3d inward = normal.cross(tangent).normalized();
  const SplineRow row = edge.spline.at(foot.arc_mm);
  // Height and tilt are measured on the surface; the shift across is the edge's own.
  const Eigen::Matrix3d turn =
      small_turn(row.dot(edge.tilt) * tangent - height_slope(edge, curve, foot.arc_mm) * inward);
  Eigen::Vector3d shift = row.dot(edge.height) * normal;
  if (follow_edge_) shift += row.dot(edge.across) * inward;
  mapped.p_scan_mm = motion * (foot.foot_mm + shift + turn * (p_cad_mm - foot.foot_mm));
  mapped.rotation_scan_from_cad = motion.linear() * turn;
  mapped.sd_mm = {edge.sd_height_mm(foot.arc_mm, curve.closed()),
                  edge.sd_across_mm(foot.arc_mm, curve.closed()), 0.0};
  mapped.sd_axis_rad = edge.sd_tilt_rad(foot.arc_mm);
  mapped.from_data = edge.seen_at(foot.arc_mm);
  mapped.in_domain = foot.distance_mm <= band_mm_;
  return mapped;
}

std::vector<double> SubdivisionField::parameters() const {
  std::vector<double> numbers;
  for (const ContourResult& contour : contours_) {
    for (const SegmentFit& fit : contour.motion.fits()) {
      const Eigen::Matrix<double, 3, 4> top = fit.scan_from_cad.matrix().topRows<3>();
      numbers.insert(numbers.end(), top.data(), top.data() + top.size());
    }
    for (const Eigen::VectorXd* v : {&contour.edge.across, &contour.edge.height, &contour.edge.tilt})
      numbers.insert(numbers.end(), v->data(), v->data() + v->size());
  }
  return numbers;
}

}  // namespace arris
