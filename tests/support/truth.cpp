#include "tests/support/truth.hpp"

#include <algorithm>
#include <cmath>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

constexpr double kStepMm = 0.25;
constexpr double kCellMm = 5.0;
constexpr double kFarthestMm = 1e4;  // a carried path farther than this from the true edge is broken

std::vector<Eigen::Vector3d> positions(const std::vector<synthetic::EdgePoint>& edge, bool deformed) {
  std::vector<Eigen::Vector3d> points;
  for (const synthetic::EdgePoint& e : edge) points.push_back(deformed ? e.true_mm : e.nominal_mm);
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

Truth::Truth(const synthetic::Part& part)
    : edge_(part.edge(0, kStepMm)),
      nominal_(positions(edge_, false), kCellMm),
      true_(positions(edge_, true), kCellMm),
      is_circle_(equally_far_from_the_middle(positions(edge_, false))) {
  length_mm_ = edge_.back().arc_mm + (edge_.front().nominal_mm - edge_.back().nominal_mm).norm();
}

Truth::Foot Truth::nearest(const synthetic::PointGrid& grid, bool deformed,
                           const Eigen::Vector3d& p_mm) const {
  std::optional<synthetic::PointGrid::Nearest> sample;
  for (double reach_mm = 2.0 * kCellMm; !sample && reach_mm < kFarthestMm; reach_mm *= 4.0)
    sample = grid.nearest(p_mm, reach_mm);
  if (!sample) throw Error(Fault::kBug, "a carried path point lies nowhere near the true edge");
  Foot best;
  best.offset_mm.setConstant(1e300);
  const std::size_t before = sample->index == 0 ? edge_.size() - 1 : sample->index - 1;
  for (const std::size_t chord : {before, sample->index}) {
    const synthetic::EdgePoint &from = edge_[chord], &to = edge_[next(chord)];
    const Eigen::Vector3d a = deformed ? from.true_mm : from.nominal_mm;
    const Eigen::Vector3d along = (deformed ? to.true_mm : to.nominal_mm) - a;
    const double ratio = std::clamp((p_mm - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector3d offset_mm = p_mm - (a + ratio * along);
    if (offset_mm.squaredNorm() < best.offset_mm.squaredNorm()) best = {chord, ratio, offset_mm};
  }
  return best;
}

double Truth::arc_mm(const Foot& foot) const {
  const double begin = edge_[foot.chord].arc_mm;
  const double end = next(foot.chord) == 0 ? length_mm_ : edge_[next(foot.chord)].arc_mm;
  return begin + foot.ratio * (end - begin);
}

std::vector<RowError> Truth::rows(std::span<const Eigen::Vector3d> carried_mm, bool deformed) const {
  std::vector<RowError> rows;
  for (const Eigen::Vector3d& p : carried_mm) {
    const Foot foot = nearest(deformed ? true_ : nominal_, deformed, p);
    const synthetic::EdgePoint &a = edge_[foot.chord], &b = edge_[next(foot.chord)];
    const auto between = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return Eigen::Vector3d(((1.0 - foot.ratio) * from + foot.ratio * to).normalized());
    };
    const Eigen::Vector3d normal =
        deformed ? between(a.true_normal, b.true_normal) : between(a.nominal_normal, b.nominal_normal);
    const Eigen::Vector3d across =
        deformed ? between(a.true_void, b.true_void) : between(a.nominal_void, b.nominal_void);
    rows.push_back({arc_mm(foot), foot.offset_mm.norm(), foot.offset_mm.dot(normal),
                    foot.offset_mm.dot(across), p - foot.offset_mm});
  }
  return rows;
}

PathError Truth::error(std::span<const Eigen::Vector3d> nominal_mm,
                       std::span<const Eigen::Vector3d> carried_mm) const {
  PathError error;
  const double share = 1.0 / static_cast<double>(carried_mm.size());
  const std::vector<RowError> found = rows(carried_mm, true);
  for (std::size_t i = 0; i < carried_mm.size(); ++i) {
    error.mean_mm += share * found[i].distance_mm;
    error.max_mm = std::max(error.max_mm, found[i].distance_mm);
    error.normal_mm += share * std::abs(found[i].normal_mm);
    error.across_mm += share * std::abs(found[i].across_mm);
    const double slid_mm = found[i].arc_mm - arc_mm(nearest(nominal_, false, nominal_mm[i]));
    error.along_mm += share * std::abs(std::remainder(slid_mm, length_mm_));
  }
  return error;
}

}  // namespace arris::bench
