#include "registration/segment_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/geometry/parallel_for.hpp"
#include "registration/carried_curve.hpp"

namespace arris {
namespace {

constexpr double kCosNormalsAgree = 0.5;  // partners need normals within 60 degrees
constexpr double kMisfitSigmaMm = 0.15;   // a rigid segment on a bending part: misfit along the normal
constexpr double kEdgeReachMm = 30.0;  // an edge point farther from every carried contour is another edge's
constexpr double kSurfaceReachMm = 10.0;
constexpr std::size_t kChunk = 512;

std::vector<CarriedCurve> carried_curves(const std::vector<ContourMotion>& motions) {
  std::vector<CarriedCurve> curves;
  for (const ContourMotion& motion : motions) curves.emplace_back(motion);
  return curves;
}

/// Nearest carried contour of a scan point, and the nominal arc length of its foot.
struct Place {
  std::size_t contour = 0;
  double arc_mm = 0.0, distance_mm = 1e300;
};
Place place_of(const std::vector<CarriedCurve>& curves, const Eigen::Vector3d& p_scan_mm) {
  Place nearest;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    Place place{c, 0.0, 0.0};
    place.arc_mm = curves[c].arc_of(p_scan_mm, place.distance_mm);
    if (place.distance_mm < nearest.distance_mm) nearest = place;
  }
  return nearest;
}

/// The segments that carry p at s, and where they take it less where the scan has it.
CarriedCost blended(const ContourMotion& motion, std::size_t first, double arc_mm,
                    const Eigen::Vector3d& p_cad_mm, const Eigen::Vector3d& p_scan_mm) {
  CarriedCost cost;
  cost.gap_mm = -p_scan_mm;
  const std::vector<BlendWeight> blend = motion.subdivision().weights(arc_mm);
  cost.carrier_count = static_cast<int>(std::min(cost.carriers.size(), blend.size()));
  for (std::size_t i = 0; i < static_cast<std::size_t>(cost.carrier_count); ++i) {
    const std::size_t z = static_cast<std::size_t>(blend[i].segment);
    cost.carriers[i] = SegmentPairs::carrier(motion, first, z, p_cad_mm, blend[i].weight);
    cost.gap_mm += blend[i].weight * (motion.fits()[z].scan_from_cad * p_cad_mm);
  }
  return cost;
}

}  // namespace

double segment_middle_mm(const ContourMotion& motion, std::size_t segment) {
  const Segment& piece = motion.subdivision().segments()[segment];
  return motion.nominal().wrap_mm(0.5 * (piece.begin_mm + piece.end_mm));
}

Eigen::Vector3d segment_pivot_mm(const ContourMotion& motion, std::size_t segment) {
  return motion.nominal().point_mm(segment_middle_mm(motion, segment));
}

Eigen::Matrix3d contour_axes(const Curve& curve, double arc_mm) {
  Eigen::Matrix3d axes;
  axes.col(0) = curve.tangent(arc_mm);
  axes.col(1) = curve.normal(arc_mm).cross(axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

SegmentPairs::SegmentPairs(const CadModel& cad, const ScanModel& scan, const EdgeData& data,
                           const std::vector<ContourMotion>& motions, const SubdivisionIcpOptions& options)
    : cad_(cad),
      scan_(scan),
      data_(data),
      options_(options),
      sigma_normal_mm_(std::max(scan.noise_sigma_mm, kMisfitSigmaMm)) {
  if (options.stability != StabilityPoints::kNone) choose_stability_points(motions);
}

void SegmentPairs::choose_stability_points(const std::vector<ContourMotion>& motions) {
  const std::vector<CarriedCurve> curves = carried_curves(motions);
  std::vector<Place> places(scan_.points_mm.size());
  parallel_for(places.size(), kChunk, options_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) places[i] = place_of(curves, scan_.points_mm[i]);
  });
  for (std::size_t c = 0; c < motions.size(); ++c) {
    std::vector<std::vector<StabilityPoint>> of(motions[c].fits().size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool beside =
          places[i].distance_mm > scan_.spacing_mm && places[i].distance_mm < options_.stability_distance_mm;
      if (places[i].contour != c || !beside) continue;
      const std::vector<BlendWeight> blend = motions[c].subdivision().weights(places[i].arc_mm);
      of[static_cast<std::size_t>(blend.front().segment)].push_back({c, i});
    }
    const std::size_t limit = static_cast<std::size_t>(options_.stability_points);
    for (const std::vector<StabilityPoint>& list : of)
      for (std::size_t i = 0; i < std::min(limit, list.size()); ++i)
        stability_.push_back(list.size() <= limit ? list[i] : list[i * list.size() / limit]);
  }
}

Carrier SegmentPairs::carrier(const ContourMotion& motion, std::size_t first, std::size_t segment,
                              const Eigen::Vector3d& p_cad_mm, double weight) {
  const Eigen::Matrix3d rotation = motion.fits()[segment].scan_from_cad.linear();
  return {static_cast<int>(first + segment), weight,
          rotation * (p_cad_mm - segment_pivot_mm(motion, segment))};
}

std::vector<CarriedCost> SegmentPairs::edges(const std::vector<ContourMotion>& motions,
                                             const std::vector<std::size_t>& first) const {
  const std::vector<CarriedCurve> curves = carried_curves(motions);
  std::vector<CarriedCost> costs;
  for (std::size_t i = 0; i < data_.points_mm.size(); ++i) {
    Place place;
    if (data_.contour.empty()) {
      place = place_of(curves, data_.points_mm[i]);
    } else {
      place.contour = data_.contour[i];
      place.arc_mm = curves[place.contour].arc_of(data_.points_mm[i], place.distance_mm);
    }
    if (place.distance_mm > kEdgeReachMm) continue;
    const ContourMotion& motion = motions[place.contour];
    CarriedCost cost = blended(motion, first[place.contour], place.arc_mm,
                               motion.nominal().point_mm(place.arc_mm), data_.points_mm[i]);
    const Eigen::Matrix3d axes =
        motion.at(place.arc_mm).linear() * contour_axes(motion.nominal(), place.arc_mm);
    cost.rows = 2;
    cost.directions.row(0) = axes.col(1).transpose() / data_.sigma_across_mm;
    cost.directions.row(1) = axes.col(2).transpose() / sigma_normal_mm_;
    cost.weight = 1.0 / data_.correlated_ratio;
    costs.push_back(cost);
  }
  return costs;
}

std::vector<CarriedCost> SegmentPairs::surface(const std::vector<ContourMotion>& motions,
                                               const std::vector<std::size_t>& first) const {
  const std::vector<CarriedCurve> curves = carried_curves(motions);
  std::vector<CarriedCost> costs;
  for (const StabilityPoint& point : stability_) {
    const ContourMotion& motion = motions[point.contour];
    const Eigen::Vector3d& p_scan_mm = scan_.points_mm[point.scan_index];
    double distance_mm = 0.0;
    const double arc_mm = curves[point.contour].arc_of(p_scan_mm, distance_mm);
    const RigidMotion here = motion.at(arc_mm);
    const SurfacePoint foot = cad_.surface.closest(here.inverse() * p_scan_mm, kSurfaceReachMm);
    if (foot.triangle < 0 || foot.on_border) continue;
    const Eigen::Vector3d normal = here.linear() * foot.normal;
    if (std::abs(normal.dot(scan_.normals[point.scan_index])) < kCosNormalsAgree) continue;
    CarriedCost cost = blended(motion, first[point.contour], arc_mm, foot.foot_mm, p_scan_mm);
    cost.directions.row(0) = normal.transpose() / sigma_normal_mm_;
    costs.push_back(cost);
  }
  return costs;
}

}  // namespace arris
