#include "registration/target_match.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "acquisition/geometry/rigid_fit.hpp"

namespace arris {
namespace {

constexpr double kLineRatio = 0.05;  // spread across over spread along
constexpr double kLeastSdMm = 1e-4;  // of a pair: a target may be stated exact
constexpr double kSameDiameterMm = 1e-6;
constexpr int kCarryRounds = 3;

using Places = std::vector<Eigen::Vector3d>;

bool may_be(const FixtureTarget& target, const SeenTarget& seen) {
  return target.kind == seen.kind && std::abs(target.diameter_mm - seen.diameter_mm) < kSameDiameterMm;
}

/// Pairs anew what lies within reach of its place under the match's motion, nearest pairs first.
void pair_up(std::span<const FixtureTarget> list, std::span<const SeenTarget> seen, double reach_mm,
             TargetMatch& match) {
  struct Pair {
    double distance_mm;
    std::size_t target, seen;
  };
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < list.size(); ++t)
    for (std::size_t s = 0; s < seen.size(); ++s) {
      const double d_mm = (match.robot_from_scan * seen[s].place_mm - list[t].place_mm).norm();
      if (may_be(list[t], seen[s]) && d_mm <= reach_mm) pairs.push_back({d_mm, t, s});
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_mm < b.distance_mm; });
  std::vector<char> taken(seen.size(), 0);
  match.seen_of.assign(list.size(), -1);
  for (const Pair& pair : pairs) {
    if (taken[pair.seen] || match.seen_of[pair.target] >= 0) continue;
    taken[pair.seen] = 1;
    match.seen_of[pair.target] = static_cast<int>(pair.seen);
  }
}

/// Collects matches, each assignment once.
class Search {
 public:
  Search(std::span<const FixtureTarget> list, std::span<const SeenTarget> seen, double reach_mm)
      : list_(list), seen_(seen), reach_mm_(reach_mm) {}

  std::vector<TargetMatch> run() {
    each_triple(false, [&](const Triple& t, const Triple& s) { carry_on(t, s); });
    std::stable_sort(matches_.begin(), matches_.end(), [](const TargetMatch& a, const TargetMatch& b) {
      return a.count() != b.count() ? a.count() > b.count() : a.worst_mm < b.worst_mm;
    });
    return std::move(matches_);
  }

  std::vector<std::size_t> line() {
    std::vector<std::size_t> found;
    each_triple(true, [&](const Triple& t, const Triple&) {
      if (found.empty()) found.assign(t.begin(), t.end());
    });
    return found;
  }

 private:
  using Triple = std::array<std::size_t, 3>;

  /// Three targets of the list, on a line or not, with three seen at the same distances.
  template <class Take>
  void each_triple(bool on_line, const Take& take) const {
    for (std::size_t i = 0; i < list_.size(); ++i)
      for (std::size_t j = i + 1; j < list_.size(); ++j)
        for (std::size_t k = j + 1; k < list_.size(); ++k) {
          const Places triple = {list_[i].place_mm, list_[j].place_mm, list_[k].place_mm};
          if (on_a_line(triple) == on_line) each_seen({i, j, k}, take);
        }
  }

  [[nodiscard]] bool agree(std::size_t target_a, std::size_t target_b, std::size_t a, std::size_t b) const {
    if (a == b) return false;
    const double list_mm = (list_[target_a].place_mm - list_[target_b].place_mm).norm();
    return std::abs((seen_[a].place_mm - seen_[b].place_mm).norm() - list_mm) <= reach_mm_;
  }

  template <class Take>
  void each_seen(const Triple& t, const Take& take) const {
    for (std::size_t a = 0; a < seen_.size(); ++a) {
      if (!may_be(list_[t[0]], seen_[a])) continue;
      for (std::size_t b = 0; b < seen_.size(); ++b) {
        if (!may_be(list_[t[1]], seen_[b]) || !agree(t[0], t[1], a, b)) continue;
        for (std::size_t c = 0; c < seen_.size(); ++c)
          if (may_be(list_[t[2]], seen_[c]) && agree(t[0], t[2], a, c) && agree(t[1], t[2], b, c))
            take(t, {a, b, c});
      }
    }
  }

  /// From three pairs to all that follow from them.
  void carry_on(const Triple& t, const Triple& s) {
    TargetMatch match;
    match.seen_of.assign(list_.size(), -1);
    for (std::size_t k = 0; k < 3; ++k) match.seen_of[t[k]] = static_cast<int>(s[k]);
    if (!solve_match(list_, seen_, match)) return;
    for (int round = 0; round < kCarryRounds; ++round) {
      const std::vector<int> before = match.seen_of;
      pair_up(list_, seen_, reach_mm_, match);
      if (!solve_match(list_, seen_, match)) return;
      if (match.seen_of == before) break;
    }
    if (known_.insert(match.seen_of).second) matches_.push_back(std::move(match));
  }

  std::span<const FixtureTarget> list_;
  std::span<const SeenTarget> seen_;
  double reach_mm_;
  std::set<std::vector<int>> known_;
  std::vector<TargetMatch> matches_;
};

/// How far apart two motions put the targets of the list.
double apart_mm(std::span<const FixtureTarget> list, const TargetMatch& a, const TargetMatch& b) {
  const RigidMotion robot_from_robot = a.robot_from_scan * b.robot_from_scan.inverse();
  double most_mm = 0.0;
  for (const FixtureTarget& target : list)
    most_mm = std::max(most_mm, (robot_from_robot * target.place_mm - target.place_mm).norm());
  return most_mm;
}

}  // namespace

std::size_t TargetMatch::count() const {
  return static_cast<std::size_t>(
      std::count_if(seen_of.begin(), seen_of.end(), [](int seen) { return seen >= 0; }));
}

bool on_a_line(std::span<const Eigen::Vector3d> places_mm) {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p_mm : places_mm) centre_mm += p_mm / static_cast<double>(places_mm.size());
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p_mm : places_mm)
    squares += (p_mm - centre_mm) * (p_mm - centre_mm).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& spread = solver.eigenvalues();
  return !(spread(1) > kLineRatio * kLineRatio * spread(2));
}

double pair_weight(const FixtureTarget& target, const SeenTarget& seen) {
  return 1.0 / (seen.covariance_mm2.trace() / 3.0 + target.sd_mm * target.sd_mm + kLeastSdMm * kLeastSdMm);
}

bool solve_match(std::span<const FixtureTarget> list, std::span<const SeenTarget> seen, TargetMatch& match) {
  Places scan_mm, robot_mm;
  std::vector<double> weights;
  for (std::size_t t = 0; t < list.size(); ++t) {
    if (match.seen_of[t] < 0) continue;
    const SeenTarget& at = seen[static_cast<std::size_t>(match.seen_of[t])];
    scan_mm.push_back(at.place_mm);
    robot_mm.push_back(list[t].place_mm);
    weights.push_back(pair_weight(list[t], at));
  }
  if (scan_mm.size() < 3 || on_a_line(robot_mm) || on_a_line(scan_mm)) return false;
  const RigidFit fit = fit_rigid(scan_mm, robot_mm, weights);
  if (!fit.usable()) return false;
  match.robot_from_scan = fit.to_from;
  match.residual_mm.assign(list.size(), 0.0);
  match.worst_mm = 0.0;
  for (std::size_t t = 0; t < list.size(); ++t) {
    if (match.seen_of[t] < 0) continue;
    const Eigen::Vector3d& place_mm = seen[static_cast<std::size_t>(match.seen_of[t])].place_mm;
    match.residual_mm[t] = (match.robot_from_scan * place_mm - list[t].place_mm).norm();
    match.worst_mm = std::max(match.worst_mm, match.residual_mm[t]);
  }
  return true;
}

std::vector<TargetMatch> target_matches(std::span<const FixtureTarget> list, std::span<const SeenTarget> seen,
                                        double reach_mm) {
  return Search(list, seen, reach_mm).run();
}

std::vector<std::size_t> matching_line(std::span<const FixtureTarget> list, std::span<const SeenTarget> seen,
                                       double reach_mm) {
  return Search(list, seen, reach_mm).line();
}

ChosenMatch choose_match(std::span<const FixtureTarget> list, std::span<const TargetMatch> matches,
                         double limit_mm) {
  ChosenMatch chosen{.match = matches.front()};
  for (const TargetMatch& rival : matches.subspan(1)) {
    if (rival.count() < chosen.match.count()) break;
    if (rival.worst_mm > 2.0 * limit_mm || apart_mm(list, chosen.match, rival) <= limit_mm) continue;
    chosen.ambiguous = true;
    chosen.other = rival;
    break;
  }
  return chosen;
}

}  // namespace arris
