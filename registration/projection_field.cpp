#include "registration/projection_field.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr double kSampleMm = 2.0;

/// The place of a point beside the contour; its distance over the face is taken out and returned.
SurfacePlace place_of(const Curve& curve, const CurveFoot& foot, const Eigen::Vector3d& p_mm,
                      double& over_mm) {
  SurfacePlace place;
  place.arc_mm = foot.arc_mm;
  place.normal = curve.normal(foot.arc_mm);
  place.tangent = curve.tangent(foot.arc_mm);
  place.inward = place.normal.cross(place.tangent).normalized();
  const Eigen::Vector3d offset = p_mm - foot.foot_mm;
  over_mm = offset.dot(place.normal);
  place.p_mm = p_mm - over_mm * place.normal;
  place.across_mm = offset.dot(place.inward);
  return place;
}

/// The least turn that brings the normal of the flat face to that of a face with this slope.
Eigen::Matrix3d turn_by(const Eigen::Vector3d& slope, const Eigen::Vector3d& normal) {
  const double size = slope.norm();
  if (size == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(std::atan(size), slope.cross(normal).normalized()).toRotationMatrix();
}

void append(const FlatTarget& plane, std::vector<double>& numbers) {
  numbers.insert(numbers.end(), plane.point_mm.begin(), plane.point_mm.end());
  numbers.insert(numbers.end(), plane.normal.begin(), plane.normal.end());
}
void append(const BentParabola& p, std::vector<double>& numbers) {
  for (const Eigen::Vector3d& v : {p.centre_mm, p.across_axis, p.along_axis})
    numbers.insert(numbers.end(), v.begin(), v.end());
  // slopes and curvatures are small: as heights 100 mm from the centre they survive rounding
  numbers.insert(numbers.end(), {p.offset_mm, 1e2 * p.lean, 1e2 * p.rise, 1e4 * p.alpha_per_mm});
}
void append(const HeightSpline& h, std::vector<double>& numbers) {
  for (const Eigen::VectorXd* v : {&h.height_mm, &h.tilt_rad})
    numbers.insert(numbers.end(), v->data(), v->data() + v->size());
}

ProjectionResidual residual_of(const Curve& curve, const ProjectionModel& model, const EdgeFit& edge) {
  ProjectionResidual left;
  double count = 0.0;
  for (double s_mm = 0.0; s_mm < curve.length_mm(); s_mm += kSampleMm) {
    if (!edge.seen_at(s_mm)) continue;
    const SplineRow row = edge.spline.at(s_mm);
    const SurfaceHeight modelled = contour_height(curve, model, s_mm);
    const Eigen::Vector3d inward = curve.normal(s_mm).cross(curve.tangent(s_mm)).normalized();
    const double height_mm = row.dot(edge.height) - modelled.mm, across_mm = row.dot(edge.across);
    const double tilt_rad = row.dot(edge.tilt) - modelled.slope.dot(inward);
    left.height_rms_mm += height_mm * height_mm;
    left.across_rms_mm += across_mm * across_mm;
    left.tilt_rms_rad += tilt_rad * tilt_rad;
    left.height_max_mm = std::max(left.height_max_mm, std::abs(height_mm));
    left.across_max_mm = std::max(left.across_max_mm, std::abs(across_mm));
    count += 1.0;
  }
  for (double* sum : {&left.height_rms_mm, &left.across_rms_mm, &left.tilt_rms_rad})
    *sum = std::sqrt(*sum / std::max(1.0, count));
  return left;
}

}  // namespace

SurfaceHeight contour_height(const Curve& contour, const ProjectionModel& model, double arc_mm) {
  CurveFoot foot;
  foot.arc_mm = arc_mm;
  foot.foot_mm = contour.point_mm(arc_mm);
  double over_mm = 0.0;
  return height_at(model, place_of(contour, foot, foot.foot_mm, over_mm));
}

ContourProjection project_contour(const CadModel& cad, std::size_t contour, const ScanModel& scan,
                                  const RigidMotion& scan_from_cad, const EdgeFit& edge,
                                  const ProjectionOptions& options) {
  const Curve& curve = cad.contours[contour];
  ContourProjection projection{edge, {}};
  if (options.kind == ProjectionKind::kSpline) {
    projection.fit = height_spline_of(edge);
  } else {
    const std::vector<HeightSample> samples =
        measured_heights(cad, contour, scan, scan_from_cad, options.distance_mm, options.threads);
    projection.fit = options.kind == ProjectionKind::kPlane ? fit_flat_target(curve, samples)
                                                            : fit_bent_parabola(curve, samples);
  }
  if (projection.fit.usable()) projection.residual = residual_of(curve, projection.fit.model, edge);
  return projection;
}

ProjectionField::ProjectionField(const CadModel& cad, const RigidMotion& scan_from_cad,
                                 std::vector<ContourProjection> contours, double band_mm)
    : nominal_(cad.contours),
      scan_from_cad_(scan_from_cad),
      contours_(std::move(contours)),
      band_mm_(band_mm) {}

MappedPoint ProjectionField::map(const Eigen::Vector3d& p_cad_mm) const {
  MappedPoint mapped;
  if (nominal_.empty()) return mapped;
  const auto [c, foot] = nearest_contour(nominal_, p_cad_mm);
  const ContourProjection& contour = contours_[c];
  double over_mm = 0.0;
  const SurfacePlace place = place_of(nominal_[c], foot, p_cad_mm, over_mm);
  const SurfaceHeight height = height_at(contour.fit.model, place);
  const Eigen::Matrix3d turn = turn_by(height.slope, place.normal);
  mapped.p_scan_mm =
      scan_from_cad_ * (place.p_mm + height.mm * place.normal + over_mm * (turn * place.normal));
  mapped.rotation_scan_from_cad = scan_from_cad_.linear() * turn;
  const bool closed = nominal_[c].closed();
  const ProjectionResidual& left = contour.residual;
  mapped.sd_mm = {std::hypot(contour.edge.sd_height_mm(foot.arc_mm, closed), left.height_rms_mm),
                  std::hypot(contour.edge.sd_across_mm(foot.arc_mm, closed), left.across_rms_mm), 0.0};
  mapped.sd_axis_rad = std::hypot(contour.edge.sd_tilt_rad(foot.arc_mm), left.tilt_rms_rad);
  mapped.from_data = contour.edge.seen_at(foot.arc_mm);
  mapped.in_domain = contour.fit.usable() && foot.distance_mm <= band_mm_;
  return mapped;
}

std::vector<double> ProjectionField::parameters() const {
  const Eigen::Matrix<double, 3, 4> top = scan_from_cad_.matrix().topRows<3>();
  std::vector<double> numbers(top.data(), top.data() + top.size());
  for (const ContourProjection& contour : contours_)
    std::visit([&](const auto& model) { append(model, numbers); }, contour.fit.model);
  return numbers;
}

}  // namespace arris
