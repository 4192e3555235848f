#include "acquisition/geometry/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/types/error.hpp"

namespace arris {
Curve::Curve(const Contour& contour) : contour_(contour) {
  const std::size_t count = contour_.points_mm.size();
  if (count < 3) contour_.closed = false;  // two points enclose nothing: their chord is walked once
  if (!contour_.normals.empty() && contour_.normals.size() != count)
    throw Error(Fault::kBug, "Curve: " + std::to_string(contour_.normals.size()) + " normals for " +
                                 std::to_string(count) + " points");
  const std::size_t segments = count == 0 ? 0 : count - (contour_.closed ? 0 : 1);
  arc_mm_.assign(1, 0.0);
  for (std::size_t i = 0; i < segments; ++i)
    arc_mm_.push_back(arc_mm_.back() + (end_of(i) - contour_.points_mm[i]).norm());
  if (!(arc_mm_.back() > 0.0) || !std::isfinite(arc_mm_.back()))
    throw Error(Fault::kBug, "Curve: contour " + std::to_string(contour_.id) + " has " +
                                 std::to_string(count) +
                                 " points and no length; need two distinct finite points");
  std::vector<Eigen::AlignedBox3d> boxes_mm;
  for (std::size_t i = 0; i < segments; ++i) {
    boxes_mm.emplace_back(contour_.points_mm[i]);
    boxes_mm.back().extend(end_of(i));
  }
  tree_ = BoxTree(boxes_mm);
  std::int32_t chord = 0;
  for (std::size_t k = 0; k < segments; ++k) {
    const double begin_mm = length_mm() * static_cast<double>(k) / static_cast<double>(segments);
    while (arc_mm_[static_cast<std::size_t>(chord) + 1] <= begin_mm) ++chord;
    chord_at_.push_back(chord);
  }
}

const Eigen::Vector3d& Curve::end_of(std::size_t segment) const {
  return segment + 1 < contour_.points_mm.size() ? contour_.points_mm[segment + 1]
                                                 : contour_.points_mm.front();
}

double Curve::wrap_mm(double arc_mm) const {
  const double length = length_mm();
  if (!closed()) return std::clamp(arc_mm, 0.0, length);
  const double wrapped = arc_mm - std::floor(arc_mm / length) * length;
  return wrapped >= 0.0 && wrapped < length ? wrapped : 0.0;
}

double Curve::arc_between_mm(double from_mm, double to_mm) const {
  const double way_mm = wrap_mm(to_mm) - wrap_mm(from_mm);
  if (!closed()) return way_mm;
  if (way_mm > 0.5 * length_mm()) return way_mm - length_mm();
  if (way_mm <= -0.5 * length_mm()) return way_mm + length_mm();
  return way_mm;
}

Curve::Locus Curve::locate(double arc_mm) const {
  const double s_mm = wrap_mm(arc_mm);
  // The last chord that begins at or before s; at the far end, the last that has length.
  const auto steps = static_cast<double>(chord_at_.size());
  auto segment = static_cast<std::size_t>(
      chord_at_[static_cast<std::size_t>(std::min(steps - 1.0, s_mm / length_mm() * steps))]);
  while (segment + 2 < arc_mm_.size() && arc_mm_[segment + 1] <= s_mm) ++segment;
  while (segment > 0 && (arc_mm_[segment] > s_mm || arc_mm_[segment] == length_mm())) --segment;
  const double ratio = (s_mm - arc_mm_[segment]) / (arc_mm_[segment + 1] - arc_mm_[segment]);
  return {segment, std::clamp(ratio, 0.0, 1.0)};
}

Eigen::Vector3d Curve::point_mm(double arc_mm) const {
  const Locus at = locate(arc_mm);
  const Eigen::Vector3d& start_mm = contour_.points_mm[at.segment];
  if (at.ratio == 1.0) return end_of(at.segment);
  return start_mm + at.ratio * (end_of(at.segment) - start_mm);
}

Eigen::Vector3d Curve::tangent(double arc_mm) const {
  const Locus at = locate(arc_mm);
  return (end_of(at.segment) - contour_.points_mm[at.segment]).normalized();
}

Eigen::Vector3d Curve::normal(double arc_mm) const {
  if (contour_.normals.empty()) return Eigen::Vector3d::Zero();
  const Locus at = locate(arc_mm);
  const Eigen::Vector3d& start = contour_.normals[at.segment];
  const Eigen::Vector3d& end = contour_.normals[(at.segment + 1) % contour_.normals.size()];
  const Eigen::Vector3d between = (1.0 - at.ratio) * start + at.ratio * end;
  return between.norm() > 1e-9 ? between.normalized() : start;
}

CurveFoot Curve::nearest(const Eigen::Vector3d& query_mm) const {
  CurveFoot best = nearest_within(query_mm, std::numeric_limits<double>::infinity());
  if (best.segment < 0) throw Error(Fault::kBug, "Curve::nearest: the query is not finite");
  return best;
}

Curve::ChordFoot Curve::foot_on(std::size_t segment, const Eigen::Vector3d& query_mm) const {
  const Eigen::Vector3d& start_mm = contour_.points_mm[segment];
  const Eigen::Vector3d chord_mm = end_of(segment) - start_mm;
  const double chord_mm2 = chord_mm.squaredNorm();
  const double ratio =
      chord_mm2 > 0.0 ? std::clamp(chord_mm.dot(query_mm - start_mm) / chord_mm2, 0.0, 1.0) : 0.0;
  const Eigen::Vector3d foot_mm = start_mm + ratio * chord_mm;
  return {foot_mm, ratio, (query_mm - foot_mm).squaredNorm()};
}

CurveFoot Curve::nearest_within(const Eigen::Vector3d& query_mm, double reach_mm, int hint) const {
  CurveFoot best;
  best.distance_mm = reach_mm;
  if (!query_mm.allFinite()) return best;
  double best_mm2 = reach_mm * reach_mm;
  const auto look_at = [&](std::int32_t i) {
    const ChordFoot at = foot_on(static_cast<std::size_t>(i), query_mm);
    if (at.distance2_mm2 < best_mm2 || (at.distance2_mm2 == best_mm2 && i < best.segment)) {
      best_mm2 = at.distance2_mm2;
      best.segment = i;
      best.ratio = at.ratio;
      best.foot_mm = at.foot_mm;
    }
    return best_mm2;
  };
  if (hint >= 0) look_at(hint);
  tree_.search(query_mm, best_mm2, look_at);
  if (best.segment < 0) return best;
  const auto segment = static_cast<std::size_t>(best.segment);
  best.distance_mm = std::sqrt(best_mm2);
  best.arc_mm = wrap_mm(arc_mm_[segment] + best.ratio * (arc_mm_[segment + 1] - arc_mm_[segment]));
  return best;
}

bool Curve::is_within(const Eigen::Vector3d& query_mm, double reach_mm) const {
  if (!query_mm.allFinite()) return false;
  const double reach_mm2 = reach_mm * reach_mm;
  bool found = false;
  tree_.search(query_mm, reach_mm2, [&](std::int32_t i) {
    found = found || foot_on(static_cast<std::size_t>(i), query_mm).distance2_mm2 < reach_mm2;
    return found ? 0.0 : reach_mm2;  // then nothing is nearer
  });
  return found;
}

Contour resample(const Contour& contour, double step_mm) {
  if (!(step_mm > 0.0))
    throw Error(Fault::kBug, "resample: step_mm = " + std::to_string(step_mm) + ", need > 0");
  const Curve curve(contour);
  const double steps = std::ceil(curve.length_mm() / step_mm * (1.0 - 1e-12));
  if (!(steps < 1e8))
    throw Error(Fault::kBug, "resample: step_mm = " + std::to_string(step_mm) + " is too fine");
  const int count = std::max(static_cast<int>(steps), curve.closed() ? 3 : 1);
  const int points = curve.closed() ? count : count + 1;
  Contour even;
  even.id = contour.id;
  even.closed = curve.closed();
  even.source = contour.source;
  for (int i = 0; i < points; ++i) {
    const double arc_mm = i == count ? curve.length_mm() : curve.length_mm() * i / count;
    even.points_mm.push_back(curve.point_mm(arc_mm));
    if (!contour.normals.empty()) even.normals.push_back(curve.normal(arc_mm));
  }
  return even;
}

}  // namespace arris
