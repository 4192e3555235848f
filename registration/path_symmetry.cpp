#include "registration/path_symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/geometry/evenly_drawn.hpp"
#include "registration/normal_equations.hpp"

namespace arris {
namespace {

constexpr double kOffMostMm = 0.1, kCosAxesAgree = 0.99985;  // 1 degree
constexpr double kNearRatio = 0.15;  // of the path's reach: what settling may move a place by
constexpr double kStepsALength = 120.0;
constexpr int kRounds = 15;
constexpr std::size_t kSettlingPlaces = 200;  // at most; all are judged afterwards
constexpr double kStillMm = 1e-3;
constexpr double kDamping = 1e-7;  // of the mean information: a circle's turn is free

}  // namespace

PathSymmetry::PathSymmetry(const std::vector<Contour>& path) {
  for (const Contour& polyline : path) {
    if (polyline.points_mm.size() < 2 || !(length_mm(polyline) > 0.0)) continue;
    curves_.emplace_back(polyline);
    const Curve& curve = curves_.back();
    const auto add = [&](double s_mm) {
      places_.push_back(
          {curve.point_mm(s_mm), polyline.normals.empty() ? Eigen::Vector3d::Zero() : curve.normal(s_mm)});
    };
    for (int i = 0; i < static_cast<int>(polyline.points_mm.size()); ++i) add(curve.arc_of_point_mm(i));
    for (double i = 0.5; i < kStepsALength; i += 1.0) add(i / kStepsALength * curve.length_mm());
  }
  for (const Place& place : places_) pivot_mm_ += place.tip_mm / static_cast<double>(places_.size());
  for (const Place& place : places_) reach_mm_ = std::max(reach_mm_, (place.tip_mm - pivot_mm_).norm());
}

PathSymmetry::Foot PathSymmetry::nearest(const Eigen::Vector3d& p_mm, const Foot& hint) const {
  Foot best;
  best.at.distance_mm = std::numeric_limits<double>::infinity();
  if (hint.at.segment >= 0)
    best = {hint.curve, curves_[hint.curve].nearest_within(p_mm, best.at.distance_mm, hint.at.segment)};
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    if (c == best.curve && best.at.segment >= 0) continue;
    const CurveFoot foot = curves_[c].nearest_within(p_mm, best.at.distance_mm);
    if (foot.segment >= 0) best = {c, foot};
  }
  return best;
}

bool PathSymmetry::may_settle(const RigidMotion& motion) const {
  const double reach_mm = kNearRatio * reach_mm_ + 2.0 * kOffMostMm;
  return std::all_of(places_.begin(), places_.end(), [&](const Place& place) {
    const Eigen::Vector3d x = motion * place.tip_mm;
    return std::any_of(curves_.begin(), curves_.end(),
                       [&](const Curve& curve) { return curve.is_within(x, reach_mm); });
  });
}

RigidMotion PathSymmetry::settled(RigidMotion motion) const {
  const std::vector<std::size_t> chosen = evenly_drawn(places_.size(), kSettlingPlaces);
  std::vector<Foot> feet(places_.size());
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector3d pivot_mm = motion * pivot_mm_;
    NormalEquations sum;
    for (const std::size_t i : chosen) {
      const Eigen::Vector3d x = motion * places_[i].tip_mm;
      feet[i] = nearest(x, feet[i]);
      const Eigen::Matrix3d axes = frame_with_z(curves_[feet[i].curve].tangent(feet[i].at.arc_mm));
      for (int k = 0; k < 2; ++k)
        sum.add(x - pivot_mm, axes.col(k), axes.col(k).dot(x - feet[i].at.foot_mm), 1.0);
    }
    Eigen::Matrix<double, 6, 1> damping;
    damping << Eigen::Vector3d::Constant(reach_mm_ * reach_mm_), Eigen::Vector3d::Ones();
    const Eigen::Matrix<double, 6, 1> step = sum.solve(kDamping * sum.weight * damping);
    motion = motion_of(step, pivot_mm) * motion;
    if (reach_mm_ * step.head<3>().norm() + step.tail<3>().norm() < kStillMm) break;
  }
  return motion;
}

double PathSymmetry::farthest_off_mm(const RigidMotion& motion) const {
  double most_mm = 0.0;
  for (const Place& place : places_)
    most_mm = std::max(most_mm, nearest(motion * place.tip_mm, {}).at.distance_mm);
  return most_mm;
}

bool PathSymmetry::maps_onto_itself(const RigidMotion& motion) const {
  if (places_.empty() || !may_settle(motion)) return false;
  const RigidMotion exact = settled(motion);
  return std::all_of(places_.begin(), places_.end(), [&](const Place& place) {
    const Eigen::Vector3d x = exact * place.tip_mm;
    if ((x - motion * place.tip_mm).norm() > kNearRatio * reach_mm_) return false;
    const Foot foot = nearest(x, {});
    if (foot.at.distance_mm > kOffMostMm) return false;
    return place.axis.isZero() ||
           (exact.linear() * place.axis).dot(curves_[foot.curve].normal(foot.at.arc_mm)) > kCosAxesAgree;
  });
}

}  // namespace arris
