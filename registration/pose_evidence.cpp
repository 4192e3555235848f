#include "registration/pose_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/geometry/median.hpp"

namespace arris {
namespace {

constexpr double kSpacings = 0.5;       // what all of an edge is off by, alike, tells nothing
constexpr double kStrainRatio = 0.003;  // of the contour's size: more is no elastic part
constexpr double kLeastSpacings = 6.0;  // of a contour's length: a shorter difference may be noise
constexpr int kFewestPlaces = 5, kMostPlaces = 240, kUsualPlaces = 60;
constexpr double kShownTolerances = 2.0;  // a rigid pose of a bent part leaves so much
constexpr double kLaidRatio = 0.8;        // of the places shown: parallel sides alone are half of an opening
constexpr double kTellsRatio = 0.5;       // of the difference: nearer to one of the two than to the other

/// In the face and along its normal; mm.
struct Off {
  double in_face_mm, height_mm;
};

Off off_between(const Eigen::Vector3d& difference_mm, const Eigen::Vector3d& normal) {
  const double height_mm = normal.dot(difference_mm);
  return {(difference_mm - height_mm * normal).norm(), std::abs(height_mm)};
}

Off off_edge(const LightScan& scan, const Eigen::Vector3d& p_mm, const Eigen::Vector3d& normal) {
  const Neighbour nearest = scan.edges.nearest(p_mm);
  if (nearest.index < 0) return {std::numeric_limits<double>::infinity(), 0.0};
  return off_between(scan.model.edge_mm[static_cast<std::size_t>(nearest.index)] - p_mm, normal);
}

/// From a place to the nearest contour of the drawing, all of them counted.
Off off_drawing(const CadModel& cad, const Eigen::Vector3d& p_mm, const Eigen::Vector3d& normal) {
  CurveFoot nearest = nearest_contour(cad.contours, p_mm).foot;
  if (!cad.others.empty()) {
    const CurveFoot foot = nearest_contour(cad.others, p_mm).foot;
    if (cad.contours.empty() || foot.distance_mm < nearest.distance_mm) nearest = foot;
  }
  return off_between(p_mm - nearest.foot_mm, normal);
}

/// Places along a contour to be looked at: a spacing apart, within bounds.
int places_along(const Curve& curve, double spacing_mm) {
  return std::clamp(static_cast<int>(curve.length_mm() / spacing_mm), kUsualPlaces, kMostPlaces);
}

/// Along one contour: where the two poses put different edges, how much nearer the scan's edge is to
/// the pose taken, over the difference. Without enough such places nothing.
bool tells_along(const CadModel& cad, const Curve& curve, const LightScan& scan, const RigidMotion& taken,
                 const RigidMotion& other, const PoseTolerance& tolerance) {
  const RigidMotion other_from_taken = taken.inverse() * other;  // of the drawing, in its own frame
  const double spacing_mm = scan.model.spacing_mm;
  const int places = places_along(curve, spacing_mm);
  std::vector<double> gains;
  for (int i = 0; i < places; ++i) {
    const double s_mm = i * curve.length_mm() / places;
    const Eigen::Vector3d p = curve.point_mm(s_mm), normal = curve.normal(s_mm);
    const Off apart = off_drawing(cad, other_from_taken * p, other_from_taken.linear() * normal);
    const bool in_face = apart.in_face_mm > tolerance.in_face_mm;
    if (!in_face && apart.height_mm <= tolerance.height_mm) continue;
    const Off here = off_edge(scan, taken * p, taken.linear() * normal);
    const Off there = off_edge(scan, other * p, other.linear() * normal);
    const double most_mm = in_face ? apart.in_face_mm : apart.height_mm;
    const auto counted_mm = [&](const Off& off) {
      return std::min(in_face ? off.in_face_mm : off.height_mm, most_mm);
    };
    gains.push_back((counted_mm(there) - counted_mm(here)) / most_mm);
  }
  const double differs_mm = static_cast<double>(gains.size()) * curve.length_mm() / places;
  return static_cast<int>(gains.size()) >= kFewestPlaces && differs_mm >= kLeastSpacings * spacing_mm &&
         median_of(std::move(gains)) > kTellsRatio;
}

}  // namespace

PoseTolerance pose_tolerance(double spacing_mm, double size_mm, double fits_mm) {
  return {kSpacings * spacing_mm + kStrainRatio * size_mm, fits_mm};
}

bool lays_shown_on_itself(const CadModel& cad, const LightScan& scan, const RigidMotion& taken,
                          const RigidMotion& motion, const PoseTolerance& tolerance, double within_mm) {
  int shown = 0, laid = 0;
  for (const std::vector<Curve>* curves : {&cad.contours, &cad.others})
    for (const Curve& curve : *curves) {
      const int places = places_along(curve, scan.model.spacing_mm);
      for (int i = 0; i < places; ++i) {
        const double s_mm = i * curve.length_mm() / places;
        const Eigen::Vector3d p = curve.point_mm(s_mm), normal = curve.normal(s_mm);
        const Off edge = off_edge(scan, taken * p, taken.linear() * normal);
        if (edge.in_face_mm > kShownTolerances * tolerance.in_face_mm || edge.height_mm > tolerance.height_mm)
          continue;
        const Off off = off_drawing(cad, motion * p, motion.linear() * normal);
        ++shown;
        laid += off.in_face_mm <= tolerance.in_face_mm + within_mm;
      }
    }
  return shown > 0 && laid >= kLaidRatio * shown;
}

bool edges_tell_apart(const CadModel& cad, const LightScan& scan, const RigidMotion& taken,
                      const RigidMotion& other, const PoseTolerance& tolerance) {
  const auto tells = [&](const Curve& curve) {
    return tells_along(cad, curve, scan, taken, other, tolerance);
  };
  return std::any_of(cad.contours.begin(), cad.contours.end(), tells) ||
         std::any_of(cad.others.begin(), cad.others.end(), tells);
}

}  // namespace arris
