#include "registration/carried_contour.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arris {

std::vector<ContourStation> contour_stations(const Curve& curve, const SurfaceBasis& basis, double step_mm) {
  std::vector<ContourStation> stations;
  const std::size_t points = curve.contour().points_mm.size();
  const std::size_t chords = curve.closed() ? points : points - 1;
  for (std::size_t i = 0; i < chords; ++i) {
    const double begin_mm = curve.arc_of_point_mm(static_cast<int>(i));
    const double end_mm = i + 1 < points ? curve.arc_of_point_mm(static_cast<int>(i + 1)) : curve.length_mm();
    const int parts = std::max(1, static_cast<int>(std::ceil((end_mm - begin_mm) / step_mm)));
    for (int k = 0; k < parts; ++k) {
      ContourStation station;
      station.arc_mm = begin_mm + (end_mm - begin_mm) * k / parts;
      station.point_mm = curve.point_mm(station.arc_mm);
      station.tangent = curve.tangent(station.arc_mm);
      station.inward = inward_of(curve, station.arc_mm);
      station.fan_per_mm = fan_per_mm(curve, station.arc_mm);
      station.row = basis.row(station.point_mm, curve.normal(station.arc_mm));
      if (station.row.usable()) stations.push_back(std::move(station));
    }
  }
  return stations;
}

CarriedContour::CarriedContour(const std::vector<ContourStation>& stations, bool closed,
                               const std::vector<Eigen::Vector3d>& shift_mm)
    : stations_(stations) {
  Contour carried;
  carried.closed = closed;
  for (const ContourStation& station : stations) {
    const LocalShape shape = local_shape(station.row, shift_mm);
    const Eigen::Matrix3d turn = shape.rotation(station.row);
    carried.points_mm.push_back(station.point_mm + shape.shift_mm);
    inward_.push_back(turn * station.inward);
    normal_.push_back(shape.normal);
  }
  curve_.emplace(carried);
}

std::optional<CarriedContour::Foot> CarriedContour::foot_within(const Eigen::Vector3d& p_cad_mm,
                                                                double reach_mm) const {
  const CurveFoot near = curve_->nearest_within(p_cad_mm, reach_mm);
  if (near.segment < 0) return std::nullopt;
  Foot foot;
  foot.distance_mm = near.distance_mm;
  const std::size_t first = static_cast<std::size_t>(near.segment), n = stations_.size();
  const std::size_t second = (first + 1) % n;
  foot.station = near.ratio < 0.5 ? first : second;
  const double begin_mm = stations_[first].arc_mm;
  const double step_mm = second == 0 ? stations_[first].arc_mm - stations_[first - 1].arc_mm
                                     : stations_[second].arc_mm - begin_mm;
  foot.arc_mm = begin_mm + near.ratio * step_mm;
  const Eigen::Vector3d apart = p_cad_mm - near.foot_mm;
  foot.across_mm = apart.dot(inward_[foot.station]);
  foot.height_mm = apart.dot(normal_[foot.station]);
  return foot;
}

}  // namespace arris
