#include "registration/edge_pairs.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "acquisition/geometry/median.hpp"

namespace arris {

namespace {

/// A little more than what the hint is away now: nothing beyond it can be the answer.
double reach_by(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm, const EdgePair& hint) {
  constexpr double kRounding = 1e-9;
  if (hint.contour < 0) return reach_mm;
  const Curve& curve = cad.contours[static_cast<std::size_t>(hint.contour)];
  return std::min(reach_mm, (1.0 + kRounding) * curve.to_segment_mm(hint.foot.segment, p_cad_mm) + kRounding);
}

}  // namespace

EdgePair pair_edge(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm,
                   const EdgePair& hint) {
  EdgePair pair;
  pair.foot.distance_mm = reach_by(cad, p_cad_mm, reach_mm, hint);
  for (std::size_t c = 0; c < cad.contours.size(); ++c) {
    const int segment = static_cast<int>(c) == hint.contour ? hint.foot.segment : -1;
    const CurveFoot foot = cad.contours[c].nearest_within(p_cad_mm, pair.foot.distance_mm, segment);
    if (foot.segment < 0) continue;
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

bool near_contours(const CadModel& cad, const Eigen::Vector3d& p_cad_mm, double reach_mm) {
  return std::any_of(cad.contours.begin(), cad.contours.end(),
                     [&](const Curve& curve) { return curve.is_within(p_cad_mm, reach_mm); });
}

std::vector<LoopAssignment> assign_loops(const CadModel& cad, const std::vector<Contour>& loops,
                                         const RigidMotion& scan_from_cad, double band_mm) {
  constexpr std::size_t kSample = 60;
  constexpr double kFollowedRatio = 0.35;  // of the contour's length
  const RigidMotion cad_from_scan = scan_from_cad.inverse();
  std::vector<LoopAssignment> assignments;
  for (const Contour& loop : loops) {
    std::vector<double> distance_mm;
    std::vector<int> votes(cad.contours.size(), 0);
    const std::size_t stride = std::max<std::size_t>(1, loop.points_mm.size() / kSample);
    for (std::size_t i = 0; i < loop.points_mm.size(); i += stride) {
      const EdgePair pair = pair_edge(cad, cad_from_scan * loop.points_mm[i], 1e9);
      distance_mm.push_back(pair.foot.distance_mm);
      if (pair.contour >= 0) ++votes[static_cast<std::size_t>(pair.contour)];
    }
    LoopAssignment assignment;
    if (!distance_mm.empty()) {
      assignment.median_mm = median_of(distance_mm);
      const std::size_t contour =
          static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
      const double contour_mm = cad.contours[contour].length_mm();
      const double near_mm = std::min(0.1 * contour_mm / 6.28, 0.5 * band_mm);
      const double near_ratio =
          static_cast<double>(std::count_if(distance_mm.begin(), distance_mm.end(),
                                            [&](double off_mm) { return off_mm < near_mm; })) /
          static_cast<double>(distance_mm.size());
      // The second: a gap joins it to the border of the scan, and most of it lies far off.
      if (assignment.median_mm < near_mm || near_ratio * length_mm(loop) > kFollowedRatio * contour_mm)
        assignment.contour = static_cast<int>(contour);
    }
    assignments.push_back(assignment);
  }
  return assignments;
}

}  // namespace arris
