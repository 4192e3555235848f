#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "acquisition/types/fixture_target.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// Something in the scan that may be a target: a sphere of one of the list's diameters, or a point that the
/// scanner's software gave.
struct SeenTarget {
  TargetKind kind = TargetKind::kSphere;
  double diameter_mm = 0.0;                                  ///< the list's diameter it was found with
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();        ///< scan frame
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Zero();  ///< of the place
};

/// Which target of the list is which of those seen, and the motion that this gives.
struct TargetMatch {
  std::vector<int> seen_of;  ///< one a target of the list: number in the seen ones, -1: not found
  RigidMotion robot_from_scan = RigidMotion::Identity();
  std::vector<double> residual_mm;  ///< one a target of the list; 0 where not found
  double worst_mm = 0.0;            ///< largest residual
  [[nodiscard]] std::size_t count() const;
};

/// Weight of a pair in solve_match(): the inverse of its variance, that of the place seen averaged over the
/// axes, and that of the list; 1/mm^2.
[[nodiscard]] double pair_weight(const FixtureTarget& target, const SeenTarget& seen);

/// Horn's closed form over the pairs of a match, weighted with pair_weight(). Fills motion and residuals;
/// false when the pairs are fewer than three or nearly on a line (see on_a_line).
bool solve_match(std::span<const FixtureTarget> list, std::span<const SeenTarget> seen, TargetMatch& match);

/// Whether places lie so near to a line that a turn about it would be told by less than a twentieth of their
/// length.
[[nodiscard]] bool on_a_line(std::span<const Eigen::Vector3d> places_mm);

/// All ways in which at least three targets fit those seen: triples whose distances agree, carried on to
/// whatever else then lies within `reach_mm` of its place, each assignment once. Most targets first, then
/// the smallest worst residual. Cost O(T^3 S^2) of T targets and S seen, both at most a few dozen.
[[nodiscard]] std::vector<TargetMatch> target_matches(std::span<const FixtureTarget> list,
                                                      std::span<const SeenTarget> seen, double reach_mm);

/// Three targets nearly on a line whose distances agree with three of those seen: what is left when
/// target_matches() finds nothing because all that is seen lies on a line. Empty: there are none.
[[nodiscard]] std::vector<std::size_t> matching_line(std::span<const FixtureTarget> list,
                                                     std::span<const SeenTarget> seen, double reach_mm);

/// The match to use, or why there is none.
struct ChosenMatch {
  TargetMatch match;
  bool ambiguous = false;  ///< another assignment fits as many targets and puts them elsewhere
  TargetMatch other = {};  ///< that one
};

/// The best of `matches` (not empty, as target_matches gives them). A rival counts when it has as many
/// targets, a worst residual below twice the limit, and puts some target of the list more than the limit
/// elsewhere.
[[nodiscard]] ChosenMatch choose_match(std::span<const FixtureTarget> list,
                                       std::span<const TargetMatch> matches, double limit_mm);

}  // namespace arris
