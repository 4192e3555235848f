#include "tests/support/truth.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

constexpr double kStepMm = 0.25;
constexpr double kCellMm = 5.0;
constexpr double kFarthestMm = 1e4;  // a carried path farther than this from the true edge is broken

std::vector<Eigen::Vector3d> positions(const std::vector<synthetic::EdgePoint>& edge,
                                       const synthetic::EdgeRange& range, bool deformed) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = range.begin; i < range.end; ++i)
    points.push_back(deformed ? edge[i].true_mm : edge[i].nominal_mm);
  return points;
}

bool equally_far_from_the_middle(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) middle += p / static_cast<double>(points.size());
  double low = 1e300, high = 0.0;
  for (const Eigen::Vector3d& p : points) {
    low = std::min(low, (p - middle).norm());
    high = std::max(high, (p - middle).norm());
  }
  return high - low < 0.02;
}

}  // namespace

Truth::Truth(const synthetic::Part& part) : Truth(part.followed_edge(kStepMm)) {}

Truth::Truth(std::vector<synthetic::EdgePoint> edge) : edge_(std::move(edge)) {
  for (const synthetic::EdgeRange& range : synthetic::contour_ranges(edge_))
    loops_.push_back(
        {range, {positions(edge_, range, false), kCellMm}, {positions(edge_, range, true), kCellMm}});
  is_circle_ =
      loops_.size() == 1 && equally_far_from_the_middle(positions(edge_, loops_.front().range, false));
}

bool Truth::near_nominal(const Eigen::Vector3d& p_cad_mm, double reach_mm) const {
  return std::any_of(loops_.begin(), loops_.end(),
                     [&](const Loop& loop) { return loop.nominal.nearest(p_cad_mm, reach_mm).has_value(); });
}

Truth::Foot Truth::nearest(bool deformed, const Eigen::Vector3d& p_mm) const {
  Foot best = nearest(0, deformed, p_mm);
  for (std::size_t loop = 1; loop < loops_.size(); ++loop) {
    const Foot foot = nearest(loop, deformed, p_mm);
    if (foot.offset_mm.squaredNorm() < best.offset_mm.squaredNorm()) best = foot;
  }
  return best;
}

Truth::Foot Truth::nearest(std::size_t loop, bool deformed, const Eigen::Vector3d& p_mm) const {
  const synthetic::EdgeRange& range = loops_[loop].range;
  const synthetic::PointGrid& grid = deformed ? loops_[loop].deformed : loops_[loop].nominal;
  std::optional<synthetic::PointGrid::Nearest> sample;
  for (double reach_mm = 2.0 * kCellMm; !sample && reach_mm < kFarthestMm; reach_mm *= 4.0)
    sample = grid.nearest(p_mm, reach_mm);
  if (!sample) throw Error(Fault::kBug, "a carried path point lies nowhere near the true edge");
  Foot best;
  best.offset_mm.setConstant(1e300);
  const std::size_t at = range.begin + sample->index;
  const std::size_t before = at == range.begin ? range.end - 1 : at - 1;
  for (const std::size_t chord : {before, at}) {
    const synthetic::EdgePoint &from = edge_[chord], &to = edge_[range.next(chord)];
    const Eigen::Vector3d a = deformed ? from.true_mm : from.nominal_mm;
    const Eigen::Vector3d along = (deformed ? to.true_mm : to.nominal_mm) - a;
    const double ratio = std::clamp((p_mm - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector3d offset_mm = p_mm - (a + ratio * along);
    if (offset_mm.squaredNorm() < best.offset_mm.squaredNorm()) best = {loop, chord, ratio, offset_mm};
  }
  return best;
}

double Truth::arc_mm(const Foot& foot) const {
  const synthetic::EdgeRange& range = loops_[foot.loop].range;
  const std::size_t next = range.next(foot.chord);
  const double begin = edge_[foot.chord].arc_mm;
  const double end = next == range.begin ? range.length_mm : edge_[next].arc_mm;
  return begin + foot.ratio * (end - begin);
}

RowError Truth::row(const Foot& foot, bool deformed, const Eigen::Vector3d& p_mm) const {
  const synthetic::EdgePoint &a = edge_[foot.chord], &b = edge_[loops_[foot.loop].range.next(foot.chord)];
  const auto between = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return Eigen::Vector3d(((1.0 - foot.ratio) * from + foot.ratio * to).normalized());
  };
  const Eigen::Vector3d normal =
      deformed ? between(a.true_normal, b.true_normal) : between(a.nominal_normal, b.nominal_normal);
  const Eigen::Vector3d across =
      deformed ? between(a.true_void, b.true_void) : between(a.nominal_void, b.nominal_void);
  return {arc_mm(foot),
          foot.offset_mm.norm(),
          foot.offset_mm.dot(normal),
          foot.offset_mm.dot(across),
          p_mm - foot.offset_mm,
          normal,
          across};
}

std::vector<RowError> Truth::rows(std::span<const Eigen::Vector3d> carried_mm, bool deformed) const {
  std::vector<RowError> rows;
  for (const Eigen::Vector3d& p : carried_mm) rows.push_back(row(nearest(deformed, p), deformed, p));
  return rows;
}

double Truth::slid_mm(const Foot& own, const RowError& carried) const {
  return std::remainder(carried.arc_mm - arc_mm(own), loops_[own.loop].range.length_mm);
}

double Truth::slid_mm(const Eigen::Vector3d& nominal_mm, const RowError& carried) const {
  return slid_mm(nearest(false, nominal_mm), carried);
}

PathError Truth::error(std::span<const Eigen::Vector3d> nominal_mm,
                       std::span<const Eigen::Vector3d> carried_mm) const {
  PathError error;
  const double share = 1.0 / static_cast<double>(carried_mm.size());
  for (std::size_t i = 0; i < carried_mm.size(); ++i) {
    const Foot own = nearest(false, nominal_mm[i]);
    const RowError found = row(nearest(own.loop, true, carried_mm[i]), true, carried_mm[i]);
    error.mean_mm += share * found.distance_mm;
    error.max_mm = std::max(error.max_mm, found.distance_mm);
    error.normal_mm += share * std::abs(found.normal_mm);
    error.across_mm += share * std::abs(found.across_mm);
    error.along_mm += share * std::abs(slid_mm(own, found));
  }
  return error;
}

}  // namespace arris::bench
