#include "registration/fixture_targets.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "registration/sphere_finder.hpp"
#include "registration/target_match.hpp"

namespace arris {
namespace {

constexpr double kReachLimits = 10.0;    // a target may be this many limits from its place, and be named
constexpr double kReachRatio = 0.25;     // but never this much of the smallest distance in the list
constexpr double kOnTargetRatio = 0.05;  // of the radius: how far off a sphere its own points may be
constexpr double kLeastRadiusMm = 1.0, kMostRadiusMm = 1000.0;  // worth looking for
constexpr std::array<double, 6> kUnitRatios = {25.4, 10.0, 1000.0, 1.0 / 25.4, 0.1, 0.001};

using Places = std::vector<Eigen::Vector3d>;
using Targets = std::span<const FixtureTarget>;

std::string plural(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

double least_distance_mm(Targets list) {
  double least_mm = 1e300;
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least_mm = std::min(least_mm, (list[i].place_mm - list[j].place_mm).norm());
  return least_mm;
}

double reach_mm(Targets list, double limit_mm) {
  return std::min(kReachLimits * limit_mm, kReachRatio * least_distance_mm(list));
}

/// What the scan shows that may be a target of the list; of a sphere the points it was fitted to as well.
struct Seen {
  std::vector<SeenTarget> targets;
  std::vector<std::size_t> points;  // one a target
};

Seen look_for(Targets list, const SphereFinder& finder, std::span<const ScanTarget> point_targets,
              double point_sd_mm) {
  Seen seen;
  std::set<double> diameters_mm;
  bool points_asked = false;
  for (const FixtureTarget& target : list) {
    if (target.kind == TargetKind::kSphere) diameters_mm.insert(target.diameter_mm);
    points_asked = points_asked || target.kind == TargetKind::kPoint;
  }
  for (const double diameter_mm : diameters_mm) {
    const double radius_mm = 0.5 * diameter_mm;
    if (radius_mm < kLeastRadiusMm || radius_mm > kMostRadiusMm) continue;
    for (const FoundSphere& sphere : finder.find(radius_mm)) {
      seen.targets.push_back({TargetKind::kSphere, diameter_mm, sphere.centre_mm, sphere.covariance_mm2});
      seen.points.push_back(sphere.points.size());
    }
  }
  if (!points_asked) return seen;
  for (const ScanTarget& point : point_targets) {
    const double sd_mm = point.sd_mm >= 0.0 ? point.sd_mm : point_sd_mm;
    seen.targets.push_back(
        {TargetKind::kPoint, 0.0, point.place_mm, sd_mm * sd_mm * Eigen::Matrix3d::Identity()});
    seen.points.push_back(0);
  }
  return seen;
}

std::vector<FixtureTarget> scaled(Targets list, double ratio) {
  std::vector<FixtureTarget> out(list.begin(), list.end());
  for (FixtureTarget& target : out) {
    target.place_mm *= ratio;
    target.diameter_mm *= ratio;
  }
  return out;
}

/// The factor that makes the list fit, diameters with it or places alone; 1: none does.
double fitting_ratio(Targets list, const SphereFinder& finder, std::span<const ScanTarget> point_targets,
                     const Seen& seen, const TargetOptions& options) {
  for (const double ratio : kUnitRatios) {
    std::vector<FixtureTarget> other = scaled(list, ratio);
    const auto fits = [&](const Seen& at) {
      const auto matches = target_matches(other, at.targets, reach_mm(other, options.max_residual_mm));
      return !matches.empty() && matches.front().worst_mm <= options.max_residual_mm;
    };
    if (fits(look_for(other, finder, point_targets, options.point_sd_mm))) return ratio;
    for (std::size_t t = 0; t < list.size(); ++t) other[t].diameter_mm = list[t].diameter_mm;
    if (fits(seen)) return ratio;
  }
  return 1.0;
}

/// Whether more targets fit the mirror image of what was seen.
bool fits_mirrored(Targets list, const Seen& seen, std::size_t count, double limit_mm) {
  std::vector<SeenTarget> mirrored = seen.targets;
  for (SeenTarget& target : mirrored) target.place_mm.x() = -target.place_mm.x();
  const auto matches = target_matches(list, mirrored, reach_mm(list, limit_mm));
  return !matches.empty() && matches.front().count() > std::max<std::size_t>(3, count) &&
         matches.front().worst_mm <= limit_mm;
}

/// One target without which the others fit, and how far it is from its place by them.
struct Culprit {
  std::size_t target;
  double distance_mm;
};
std::vector<Culprit> culprits(Targets list, const Seen& seen, const TargetMatch& match, double limit_mm) {
  std::vector<Culprit> found;
  for (std::size_t t = 0; t < list.size() && match.count() > 3; ++t) {
    if (match.seen_of[t] < 0) continue;
    TargetMatch without = match;
    without.seen_of[t] = -1;
    if (!solve_match(list, seen.targets, without) || without.worst_mm > limit_mm) continue;
    const Eigen::Vector3d& seen_mm = seen.targets[static_cast<std::size_t>(match.seen_of[t])].place_mm;
    found.push_back({t, (without.robot_from_scan * seen_mm - list[t].place_mm).norm()});
  }
  return found;
}

std::string misfit(Targets list, const Seen& seen, const TargetMatch& match, double limit_mm) {
  const std::vector<Culprit> moved = culprits(list, seen, match, limit_mm);
  if (moved.size() == 1) {
    const Culprit& one = moved.front();
    return fmt::format(
        "fixture target {} is {:.2f} mm from its place as the others show it (at most {:.2f}): it has "
        "moved, or its line in the list is wrong",
        list[one.target].id, one.distance_mm, limit_mm);
  }
  std::string names;
  for (std::size_t t = 0; t < list.size(); ++t)
    if (match.seen_of[t] >= 0)
      names += (names.empty() ? "" : ", ") + fmt::format("{} {:.2f} mm", list[t].id, match.residual_mm[t]);
  return fmt::format("the fixture targets do not fit their list (at most {:.2f} mm): ", limit_mm) + names +
         "; which of them has moved cannot be told";
}

std::string ambiguity(Targets list, const TargetMatch& one, const TargetMatch& other) {
  std::string pairs;
  for (std::size_t t = 0; t < list.size(); ++t)
    for (std::size_t u = 0; u < list.size(); ++u)
      if (t != u && one.seen_of[t] >= 0 && one.seen_of[t] == other.seen_of[u])
        pairs += (pairs.empty() ? "" : ", ") + list[t].id + " for " + list[u].id;
  return "the fixture targets fit their list in two ways" + (pairs.empty() ? "" : " (" + pairs + ")") +
         ": show more of them, or set one elsewhere";
}

std::string nothing_fits(Targets list, const Seen& seen, double limit_mm) {
  if (seen.targets.empty())
    return "no fixture target was found in the scan: the scan shows none of the spheres of the list, and no "
           "points were given with --targets";
  if (seen.targets.size() < 3)
    return plural(seen.targets.size(), "possible fixture target") + " found in the scan; 3 are needed";
  std::string line;
  for (const std::size_t t : matching_line(list, seen.targets, reach_mm(list, limit_mm)))
    line += (line.empty() ? "" : ", ") + list[t].id;
  if (!line.empty())
    return "the fixture targets found (" + line +
           ") lie nearly on a line: a turn about it stays unknown; show another one";
  return fmt::format(
      "no three of the {} possible fixture targets in the scan stand to each other as targets of "
      "the list do (within {:.1f} mm)",
      seen.targets.size(), reach_mm(list, limit_mm));
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

using Lever = Eigen::Matrix<double, 3, 6>;

/// How a point follows the turn and the move of the frame.
Lever lever(const Eigen::Vector3d& p_mm, const Eigen::Vector3d& pivot_mm) {
  Lever j;
  j << -cross_matrix(p_mm - pivot_mm), Eigen::Matrix3d::Identity();
  return j;
}

/// The weights of solve_match() make the fit linear in the errors of the places; these are then carried
/// through it, as large in each direction as they are stated.
void carry_uncertainty(Targets list, const Seen& seen, const TargetMatch& match, TargetFrame& frame) {
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero(), noise = normal;
  const Eigen::Matrix3d turn = match.robot_from_scan.linear();
  for (std::size_t t = 0; t < list.size(); ++t) {
    if (match.seen_of[t] < 0) continue;
    const SeenTarget& at = seen.targets[static_cast<std::size_t>(match.seen_of[t])];
    const double weight = pair_weight(list[t], at);
    const Lever j = lever(list[t].place_mm, frame.pivot_mm);
    const Eigen::Matrix3d covariance = turn * at.covariance_mm2 * turn.transpose() +
                                       list[t].sd_mm * list[t].sd_mm * Eigen::Matrix3d::Identity();
    normal += weight * j.transpose() * j;
    noise += weight * weight * j.transpose() * covariance * j;
  }
  const Eigen::Matrix<double, 6, 6> inverse = normal.inverse();
  frame.covariance = inverse * noise * inverse;
}

void describe(Targets list, const Seen& seen, const TargetMatch& match, double limit_mm, TargetFrame& frame) {
  frame.robot_from_scan = match.robot_from_scan;
  for (std::size_t t = 0; t < list.size(); ++t) {
    TargetSighting& sighting = frame.targets[t];
    if (match.seen_of[t] < 0) continue;
    const auto s = static_cast<std::size_t>(match.seen_of[t]);
    sighting.found = true;
    sighting.residual_mm = match.residual_mm[t];
    sighting.over_limit = match.residual_mm[t] > limit_mm;
    sighting.scan_mm = seen.targets[s].place_mm;
    sighting.sd_mm = std::sqrt(seen.targets[s].covariance_mm2.trace() / 3.0);
    sighting.points = seen.points[s];
    frame.pivot_mm += list[t].place_mm / static_cast<double>(match.count());
  }
  frame.extra = seen.targets.size() - match.count();
  carry_uncertainty(list, seen, match, frame);
}

void take_points(const SphereFinder& finder, double clear_mm, TargetFrame& frame) {
  for (const TargetSighting& sighting : frame.targets) {
    if (!sighting.found || sighting.target.kind != TargetKind::kSphere) continue;
    const double radius_mm = 0.5 * sighting.target.diameter_mm;
    const auto on =
        finder.points_near(sighting.scan_mm, radius_mm + std::max(clear_mm, kOnTargetRatio * radius_mm));
    frame.points.insert(frame.points.end(), on.begin(), on.end());
  }
  std::sort(frame.points.begin(), frame.points.end());
  frame.points.erase(std::unique(frame.points.begin(), frame.points.end()), frame.points.end());
}

void add_notes(std::size_t count, TargetFrame& frame) {
  if (count == 3)
    frame.notes.emplace_back(
        "the scanner's frame rests on three fixture targets: one that moved out of their plane would not be "
        "noticed; a fourth would show it");
  if (frame.extra > 0)
    frame.notes.push_back(plural(frame.extra, "possible fixture target") +
                          " in the scan that the list does not have; not used");
}

}  // namespace

TargetFrame solve_targets(Targets list, std::span<const Eigen::Vector3d> points_mm,
                          std::span<const ScanTarget> point_targets, const TargetOptions& options) {
  TargetFrame frame;
  for (const FixtureTarget& target : list) frame.targets.push_back({.target = target});
  SphereOptions sphere_options;
  sphere_options.threads = options.threads;
  const SphereFinder finder(points_mm, sphere_options);
  const Seen seen = look_for(list, finder, point_targets, options.point_sd_mm);
  const double limit_mm = options.max_residual_mm;
  const auto matches = target_matches(list, seen.targets, reach_mm(list, limit_mm));
  if (matches.empty()) {
    frame.extra = seen.targets.size();
    frame.unit_ratio = fitting_ratio(list, finder, point_targets, seen, options);
    frame.reasons.push_back(
        frame.unit_ratio == 1.0
            ? nothing_fits(list, seen, limit_mm)
            : fmt::format(
                  "the list of fixture targets fits the scan when it is scaled by {:g}: it is in another "
                  "unit than mm, or the scan is",
                  frame.unit_ratio));
    return frame;
  }
  const ChosenMatch chosen = choose_match(list, matches, limit_mm);
  describe(list, seen, chosen.match, limit_mm, frame);
  take_points(finder, options.clear_mm, frame);
  if (fits_mirrored(list, seen, chosen.match.count(), limit_mm))
    frame.reasons.emplace_back(
        "the fixture targets fit their list as a mirror image: the scan, or the list, has another hand");
  else if (chosen.ambiguous)
    frame.reasons.push_back(ambiguity(list, chosen.match, chosen.other));
  if (chosen.match.worst_mm > limit_mm) frame.reasons.push_back(misfit(list, seen, chosen.match, limit_mm));
  add_notes(chosen.match.count(), frame);
  return frame;
}

std::string why_list_is_unusable(Targets list, double max_residual_mm) {
  Places places_mm;
  for (const FixtureTarget& target : list) places_mm.push_back(target.place_mm);
  if (list.size() < 3) return "at least 3 targets are needed";
  const double least_mm = least_distance_mm(list);
  if (least_mm < 2.0 * kReachLimits * max_residual_mm)
    return fmt::format("two targets are only {:.3f} mm apart", least_mm);
  if (on_a_line(places_mm)) return "the targets lie nearly on a line: a turn about it would stay unknown";
  std::vector<SeenTarget> seen(list.size());
  for (std::size_t t = 0; t < list.size(); ++t) {
    seen[t].kind = list[t].kind;
    seen[t].diameter_mm = list[t].diameter_mm;
    seen[t].place_mm = list[t].place_mm;
  }
  const auto matches = target_matches(list, seen, reach_mm(list, max_residual_mm));
  if (matches.empty()) return "no three of the targets make a triangle that is wide enough";
  const ChosenMatch chosen = choose_match(list, matches, max_residual_mm);
  return chosen.ambiguous ? ambiguity(list, chosen.match, chosen.other) : std::string();
}

Eigen::Matrix3d carried_covariance_mm2(const TargetFrame& frame, const Eigen::Vector3d& p_robot_mm) {
  const Lever j = lever(p_robot_mm, frame.pivot_mm);
  return j * frame.covariance * j.transpose();
}

}  // namespace arris
