#include "registration/surface_field.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "registration/carried_contour.hpp"
#include "registration/shape_about.hpp"

namespace arris {
namespace {

constexpr double kSlideStepMm = 10.0;
constexpr double kTurnsApartSds = 1.2;  // of the axis, for each radian that two turns of it differ by

/// Nearest accepted contour; -1 when there is none.
int nearest_contour(const CadModel& cad, const Eigen::Vector3d& p_mm, CurveFoot& foot) {
  int nearest = -1;
  foot.distance_mm = 1e300;
  for (std::size_t c = 0; c < cad.contours.size(); ++c) {
    const CurveFoot candidate = cad.contours[c].nearest(p_mm);
    if (candidate.distance_mm >= foot.distance_mm) continue;
    foot = candidate;
    nearest = static_cast<int>(c);
  }
  return nearest;
}

}  // namespace

SurfaceField::SurfaceField(const CadModel& cad, SurfaceFit fit, double band_mm, ContourRole role)
    : cad_(cad), fit_(std::move(fit)), band_mm_(band_mm), role_(role) {}

MappedPoint SurfaceField::map(const Eigen::Vector3d& p_cad_mm) const {
  MappedPoint mapped;
  CurveFoot beside;
  const int contour = nearest_contour(cad_, p_cad_mm, beside);
  const SurfacePoint foot = cad_.surface.closest(p_cad_mm, band_mm_);
  if (contour < 0 || foot.triangle < 0 || beside.distance_mm > band_mm_) return mapped;
  const BasisRow row = fit_.basis->row(foot.foot_mm, cad_.smooth_normal(foot));
  if (!row.usable()) return mapped;
  const LocalShape shape = local_shape(row, fit_.shift_mm);
  const Eigen::Matrix3d turn = turn_about(foot.foot_mm, row);
  const Eigen::Vector3d inward = cad_.inward(static_cast<std::size_t>(contour), beside.arc_mm);
  Eigen::Vector3d p_mm = foot.foot_mm + shape.shift_mm + turn * (p_cad_mm - foot.foot_mm);
  const bool follow = role_ == ContourRole::kEdge;
  if (follow) p_mm += fit_.offset_mm[static_cast<std::size_t>(contour)] * (turn * inward);
  mapped.p_scan_mm = fit_.scan_from_cad * p_mm;
  mapped.rotation_scan_from_cad = fit_.scan_from_cad.linear() * turn;
  const Eigen::Vector3d tangent = inward.cross(row.normal).normalized();
  mapped.sd_mm = {sd_along_mm(row, shape.normal, -1), sd_along_mm(row, turn * inward, follow ? contour : -1),
                  sd_along_mm(row, turn * tangent, -1)};
  // Across, the edge itself shows what strain does; along it nothing does.
  mapped.sd_mm.z() = std::hypot(mapped.sd_mm.z(), sd_strained_mm(row, turn * tangent));
  mapped.sd_mm.y() =
      std::hypot(mapped.sd_mm.y(), follow ? fit_.scanner_sd_mm : sd_strained_mm(row, turn * inward));
  mapped.sd_axis_rad = sd_tilt_rad(row, inward, shape.normal);
  const double more_mm2 = unfollowed_mm2(row), wave_mm = 2.0 * row.spacing_mm;
  mapped.sd_mm.x() = std::hypot(mapped.sd_mm.x(), std::sqrt(more_mm2));
  mapped.sd_axis_rad = std::hypot(
      mapped.sd_axis_rad, 2.0 * std::numbers::pi / wave_mm * std::sqrt(more_mm2 + fit_.unfollowed_mean_mm2));
  // How far two ways to take the turn from the same nodes differ says how far nodes so far apart can be off
  // (Zienkiewicz and Zhu, Int. J. Numer. Meth. Eng. 24, 1987).
  const double apart_rad = (turn * row.normal - shape.normal).dot(turn * inward);
  mapped.sd_axis_rad = std::hypot(mapped.sd_axis_rad, kTurnsApartSds * apart_rad);
  mapped.from_data = seen_.empty() || seen_[static_cast<std::size_t>(contour)].at(beside.arc_mm);
  mapped.in_domain = true;
  return mapped;
}

Eigen::Matrix3d SurfaceField::turn_about(const Eigen::Vector3d& foot_mm, const BasisRow& row) const {
  return shape_about(cad_, *fit_.basis, foot_mm, row, fit_.shift_mm).rotation(row);
}

double SurfaceField::sd_along_mm(const BasisRow& row, const Eigen::Vector3d& direction, int offset) const {
  const Eigen::MatrixXd& c = fit_.covariance;
  if (c.size() == 0) return 0.0;
  const Eigen::Index last = static_cast<Eigen::Index>(3 * fit_.shift_mm.size()) + offset;
  double variance = offset < 0 ? 0.0 : c(last, last);
  for (std::size_t a = 0; a < row.node.size(); ++a) {
    const Eigen::Index at = 3 * row.node[a];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t b = 0; b < row.node.size(); ++b)
      sum += row.weight[b][0] * (c.block<3, 3>(at, 3 * row.node[b]) * direction);
    if (offset >= 0) sum += 2.0 * c.block<3, 1>(at, last);
    variance += row.weight[a][0] * direction.dot(sum);
  }
  return std::sqrt(std::max(0.0, variance));
}

double SurfaceField::sd_strained_mm(const BasisRow& row, const Eigen::Vector3d& direction) const {
  const Eigen::MatrixXd& moves = fit_.common_strain_mm;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(moves.cols());
  for (std::size_t k = 0; k < row.node.size() && moves.cols() > 0; ++k)
    sum += row.weight[k][BasisRow::kValue] * (direction.transpose() * moves.middleRows<3>(3 * row.node[k]));
  return sum.norm();
}

double SurfaceField::sd_tilt_rad(const BasisRow& row, const Eigen::Vector3d& inward,
                                 const Eigen::Vector3d& normal) const {
  // The basis' own slope across the contour, known worse than the rings' plane: at a free edge the axis is
  // off by what bends within the rings as well, of which the plane's covariance knows nothing.
  BasisRow slope = row;
  for (BasisRow::Weights& w : slope.weight)
    w[BasisRow::kValue] = row.t1.dot(inward) * w[BasisRow::kD1] + row.t2.dot(inward) * w[BasisRow::kD2];
  return sd_along_mm(slope, normal, -1);
}

double SurfaceField::unfollowed_mm2(const BasisRow& row) const {
  double sum_mm2 = 0.0;
  for (std::size_t k = 0; k < row.node.size() && !fit_.unfollowed_mm2.empty(); ++k)
    sum_mm2 += row.weight[k][BasisRow::kValue] * fit_.unfollowed_mm2[static_cast<std::size_t>(row.node[k])];
  return std::max(0.0, sum_mm2);
}

Eigen::Matrix3d SurfaceField::slide_covariance_mm2(std::size_t contour) const {
  const Curve& curve = cad_.contours[contour];
  std::vector<double> share(fit_.shift_mm.size(), 0.0);
  const std::vector<ContourStation> stations = contour_stations(curve, *fit_.basis, kSlideStepMm);
  for (const ContourStation& station : stations)
    for (std::size_t k = 0; k < station.row.node.size(); ++k)
      share[static_cast<std::size_t>(station.row.node[k])] +=
          station.row.weight[k][BasisRow::kValue] / static_cast<double>(stations.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < share.size(); ++a)
    for (std::size_t b = 0; b < share.size(); ++b)
      if (share[a] != 0.0 && share[b] != 0.0)
        covariance +=
            share[a] * share[b] *
            fit_.covariance.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
  const Eigen::Matrix3d& turn = fit_.scan_from_cad.linear();
  return turn * covariance * turn.transpose();
}

RigidMotion SurfaceField::material_motion(std::size_t contour, double arc_mm) const {
  const Curve& curve = cad_.contours[contour];
  const Eigen::Vector3d p_mm = curve.point_mm(arc_mm);
  const BasisRow row = fit_.basis->row(p_mm, curve.normal(arc_mm));
  if (!row.usable()) return fit_.scan_from_cad;
  const LocalShape shape = local_shape(row, fit_.shift_mm);
  RigidMotion moved = RigidMotion::Identity();
  moved.linear() = turn_about(p_mm, row);
  moved.translation() = p_mm + shape.shift_mm - moved.linear() * p_mm;
  return fit_.scan_from_cad * moved;
}

std::vector<double> SurfaceField::parameters() const {
  const Eigen::Matrix<double, 3, 4> top = fit_.scan_from_cad.matrix().topRows<3>();
  std::vector<double> numbers(top.data(), top.data() + top.size());
  for (const Eigen::Vector3d& shift : fit_.shift_mm)
    numbers.insert(numbers.end(), shift.data(), shift.data() + 3);
  numbers.insert(numbers.end(), fit_.offset_mm.begin(), fit_.offset_mm.end());
  return numbers;
}

}  // namespace arris
