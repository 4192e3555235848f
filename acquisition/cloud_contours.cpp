#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "acquisition/contour_extract.hpp"
#include "acquisition/contour_set.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/smooth_surface.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {
namespace {

constexpr double kBesideCos = 0.7;     // normals of points of one smooth face, a disc apart
constexpr double kJoinSpacings = 4.0;  // ends of broken chains no farther apart than this belong together,
constexpr double kFarJoinSpacings = 12.0;  // or than this if both chains are long beside the gap
constexpr double kFarJoinRatio = 0.1;
// The edge of a cloud is ragged by a third of a spacing and more.
constexpr BendWindow kRaggedBend{.chords = 8.0, .exact_corners = false};
constexpr std::size_t kFewestClosed = 8;    // a chain of fewer points is not closed
constexpr double kShortestSpacings = 20.0;  // shorter loops are voids of the sampling
constexpr std::size_t kChunk = 256;
constexpr double kLargestMismatch_rad = 0.5 * std::numbers::pi;  // between the disc's places at two points
constexpr double kAcrossRatio = 0.12;  // mean squared sine of a row's neighbours; half in an even cloud
constexpr double kRowsRatio = 0.5;     // of the points
constexpr double kSureOverlap = 1e-9;  // of arcs, against rounding
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Largest angle between neighbours, seen in the tangent plane.
double largest_gap_rad(const Eigen::Vector3d& p, const Eigen::Matrix3d& frame,
                       std::span<const Eigen::Vector3d> points_mm, const std::vector<std::int32_t>& near,
                       std::vector<double>& angles) {
  angles.clear();
  for (const std::int32_t index : near) {
    const Eigen::Vector3d d = points_mm[static_cast<std::size_t>(index)] - p;
    if (d.squaredNorm() > 0.0) angles.push_back(std::atan2(frame.col(1).dot(d), frame.col(0).dot(d)));
  }
  if (angles.size() < 3) return 0.0;
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + kTwoPi - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
  return gap;
}

/// Share of points (a sample of some thousand) whose nearest all lie along the line to the very nearest: they
/// show a row, no surface.
double row_ratio(std::span<const Eigen::Vector3d> points_mm, const NeighbourTable& table) {
  const std::size_t step = 1 + points_mm.size() / 2000;
  std::size_t rows = 0, looked_at = 0;
  for (std::size_t i = 0; i < points_mm.size(); i += step, ++looked_at) {
    Eigen::Vector3d line = Eigen::Vector3d::Zero();
    double across = 0.0, along = 0.0;
    for (const std::int32_t j : table.of(i)) {
      if (j < 0) continue;
      const Eigen::Vector3d d = points_mm[static_cast<std::size_t>(j)] - points_mm[i];
      if (line.isZero()) line = d;
      const double share = d.dot(line) * d.dot(line) / (d.squaredNorm() * line.squaredNorm());
      if (!std::isfinite(share)) continue;  // points in one place
      along += share;
      across += 1.0 - share;
    }
    if (across < kAcrossRatio * (across + along)) ++rows;
  }
  return looked_at == 0 ? 0.0 : static_cast<double>(rows) / static_cast<double>(looked_at);
}

/// A direction in which the empty disc can touch a point, between two neighbours that stop it. With the
/// material on the left of the walk, the walk arrives from `before` and leaves to `after`.
struct Touch {
  std::int32_t before = -1, after = -1;
  double from_rad = 0.0, to_rad = 0.0;  // directions of the disc's centre, counter-clockwise
};

/// All free directions of a disc of radius r at a point: each neighbour at distance d blocks phi +- acos(d /
/// 2r).
class TouchFinder {
 public:
  TouchFinder(std::span<const Eigen::Vector3d> points_mm, const std::vector<Eigen::Vector3d>& normals,
              double disc_mm)
      : points_mm_(points_mm), normals_(normals), disc_mm_(disc_mm) {}

  /// True only if no direction is free: each blocked arc overlaps the next one around. Without the sines of
  /// touches_of(), which the few points that fail need.
  bool is_enclosed(std::size_t i, const std::vector<std::int32_t>& near) {
    const Eigen::Matrix3d frame = frame_with_z(normals_[i]);
    around_.clear();
    for (const std::int32_t index : near) {
      const Eigen::Vector3d d = points_mm_[static_cast<std::size_t>(index)] - points_mm_[i];
      const double x = frame.col(0).dot(d), y = frame.col(1).dot(d);
      const double distance_mm = std::sqrt(x * x + y * y);
      const double cosine = distance_mm / (2.0 * disc_mm_);
      if (!(cosine > 0.0 && cosine < 1.0)) continue;
      const double order = x / (std::abs(x) + std::abs(y));  // falls from 1 to -1 while the angle grows to pi
      around_.push_back({y < 0.0 ? 2.0 + order : -order, x / distance_mm, y / distance_mm, cosine,
                         std::sqrt(1.0 - cosine * cosine)});
    }
    std::sort(around_.begin(), around_.end(), [](const Arc& a, const Arc& b) { return a.order < b.order; });
    for (std::size_t k = 0; k < around_.size(); ++k) {
      const Arc &a = around_[k], &b = around_[(k + 1) % around_.size()];
      const bool less_than_half_a_turn = a.x * b.y - a.y * b.x > 0.0;
      const bool overlap = a.x * b.x + a.y * b.y > a.cosine * b.cosine - a.sine * b.sine + kSureOverlap;
      if (!less_than_half_a_turn || !overlap) return false;
    }
    return around_.size() > 2;
  }

  std::vector<Touch> touches_of(std::size_t i, const std::vector<std::int32_t>& near) {
    const Eigen::Matrix3d frame = frame_with_z(normals_[i]);
    blocked_.clear();
    for (const std::int32_t index : near) {
      const Eigen::Vector3d d = points_mm_[static_cast<std::size_t>(index)] - points_mm_[i];
      const double x = frame.col(0).dot(d), y = frame.col(1).dot(d);
      const double ratio = std::sqrt(x * x + y * y) / (2.0 * disc_mm_);
      if (!(ratio > 0.0 && ratio < 1.0)) continue;
      const double half = std::acos(ratio);
      const double from = std::atan2(y, x) - half;
      const double positive = from < 0.0 ? from + kTwoPi : from;
      blocked_.push_back({positive, positive + 2.0 * half, index});
    }
    std::sort(blocked_.begin(), blocked_.end(),
              [](const Blocked& a, const Blocked& b) { return a.from < b.from; });
    return free_directions();
  }

 private:
  struct Blocked {
    double from, to;
    std::int32_t index;
  };

  /// Sweeps twice around, so that what is blocked across zero counts.
  [[nodiscard]] std::vector<Touch> free_directions() const {
    std::vector<Touch> touches;
    if (blocked_.size() < 2) return touches;
    double reach = -1.0;
    std::int32_t holder = -1;
    for (int turn = 0; turn < 2; ++turn)
      for (const Blocked& b : blocked_) {
        const double from = b.from + turn * kTwoPi, to = b.to + turn * kTwoPi;
        if (turn == 1 && from > reach) touches.push_back({holder, b.index, reach, from});
        if (to > reach) reach = to, holder = b.index;
      }
    return touches;
  }

  /// Unit direction of a neighbour, with the cosine and sine of half the angle it blocks.
  struct Arc {
    double order, x, y, cosine, sine;
  };

  std::span<const Eigen::Vector3d> points_mm_;
  const std::vector<Eigen::Vector3d>& normals_;
  double disc_mm_;
  std::vector<Blocked> blocked_;
  std::vector<Arc> around_;
};

struct Node {
  std::int32_t point = -1;
  bool seed = false;  // an angle gap: a walk may start here
  Touch touch;
};

/// Rolls the disc from touch to touch.
class Walk {
 public:
  Walk(std::span<const Eigen::Vector3d> points_mm, const std::vector<Eigen::Vector3d>& normals,
       std::vector<Node> nodes)
      : points_mm_(points_mm), normals_(normals), nodes_(std::move(nodes)), first_(points_mm.size() + 1, 0) {
    for (const Node& node : nodes_) ++first_[static_cast<std::size_t>(node.point) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }

  /// Closed loops and open chains; each needs a seed.
  std::vector<FoundContour> loops() const {
    const std::vector<std::int32_t> next = successors();
    std::vector<char> is_head(nodes_.size(), 1), done(nodes_.size(), 0);
    for (const std::int32_t to : next)
      if (to >= 0) is_head[static_cast<std::size_t>(to)] = 0;
    std::vector<FoundContour> found;
    for (const bool closed : {false, true})
      for (std::size_t n = 0; n < nodes_.size(); ++n)
        if (!done[n] && (closed || is_head[n]))
          collect(static_cast<std::int32_t>(n), closed, next, done, found);
    return found;
  }

 private:
  struct Step {
    std::int32_t to = -1;
    double mismatch_rad = kLargestMismatch_rad;  // below zero: the next point's touch begins at this point
  };

  /// The node after each node; of two that lead to the same one the better, so that chains are disjoint.
  std::vector<std::int32_t> successors() const {
    std::vector<std::int32_t> next(nodes_.size(), -1), previous(nodes_.size(), -1);
    std::vector<double> mismatch_rad(nodes_.size(), kLargestMismatch_rad);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Step step = step_from(nodes_[n]);
      const auto to = static_cast<std::size_t>(step.to);
      if (step.to < 0 || step.mismatch_rad >= mismatch_rad[to]) continue;
      if (previous[to] >= 0) next[static_cast<std::size_t>(previous[to])] = -1;
      mismatch_rad[to] = step.mismatch_rad;
      previous[to] = static_cast<std::int32_t>(n);
      next[n] = step.to;
    }
    return next;
  }

  /// At the next point, the touch that the disc arrives in: stopped by this point, or else the nearest
  /// direction.
  Step step_from(const Node& node) const {
    const std::size_t to = static_cast<std::size_t>(node.touch.after);
    Step best;
    for (std::size_t k = first_[to]; k < first_[to + 1]; ++k) {
      const double mismatch_rad =
          nodes_[k].touch.before == node.point ? -1.0 : direction_mismatch(node, nodes_[k]);
      if (mismatch_rad < best.mismatch_rad) best = {static_cast<std::int32_t>(k), mismatch_rad};
    }
    return best;
  }

  /// Angle between the disc's place in the last touch and the start of a touch of the next point.
  double direction_mismatch(const Node& from, const Node& to) const {
    const Eigen::Vector3d a = void_direction(from, from.touch.to_rad);
    const Eigen::Vector3d b = void_direction(to, to.touch.from_rad);
    return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
  }

  Eigen::Vector3d void_direction(const Node& node, double angle_rad) const {
    const Eigen::Matrix3d frame = frame_with_z(normals_[static_cast<std::size_t>(node.point)]);
    return std::cos(angle_rad) * frame.col(0) + std::sin(angle_rad) * frame.col(1);
  }

  void collect(std::int32_t start, bool closed, const std::vector<std::int32_t>& next,
               std::vector<char>& done, std::vector<FoundContour>& found) const {
    FoundContour chain;
    chain.contour.closed = closed;
    chain.contour.source = "angle gap";
    bool seeded = false;
    for (std::int32_t n = start; n >= 0 && !done[static_cast<std::size_t>(n)];
         n = next[static_cast<std::size_t>(n)]) {
      done[static_cast<std::size_t>(n)] = 1;
      const Node& node = nodes_[static_cast<std::size_t>(n)];
      seeded = seeded || node.seed;
      chain.contour.points_mm.push_back(points_mm_[static_cast<std::size_t>(node.point)]);
      chain.contour.normals.push_back(normals_[static_cast<std::size_t>(node.point)]);
    }
    if (seeded) found.push_back(std::move(chain));
  }

  std::span<const Eigen::Vector3d> points_mm_;
  const std::vector<Eigen::Vector3d>& normals_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> first_;  // nodes of point i: first_[i] .. first_[i + 1]
};

/// Looks at one point's neighbours on the surface; scratch that one thread reuses.
class Surroundings {
 public:
  Surroundings(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
               const NeighbourTable& table, const SmoothSurface& surface, const ContourOptions& options,
               double disc_mm)
      : points_mm_(points_mm),
        tree_(tree),
        table_(table),
        surface_(surface),
        options_(options),
        disc_mm_(disc_mm),
        finder_(points_mm, surface.normals, disc_mm) {}

  bool has_angle_gap(std::size_t i) {
    take_nearest(i);
    return largest_gap_rad(points_mm_[i], frame_with_z(surface_.normals[i]), points_mm_, near_, angles_) >
           options_.angle_gap_rad;
  }

  /// The 12 nearest alone enclose most points; only the others need all neighbours that can touch the disc.
  std::vector<Touch> touches_of(std::size_t i) {
    take_nearest(i);
    if (finder_.is_enclosed(i, near_)) return {};
    tree_.within(points_mm_[i], 2.0 * disc_mm_, found_);
    near_.clear();
    for (const Neighbour& n : found_)
      if (is_beside(i, static_cast<std::size_t>(n.index))) near_.push_back(n.index);
    return finder_.touches_of(i, near_);
  }

 private:
  /// On the surface, and on the same side of a sharp edge.
  [[nodiscard]] bool is_beside(std::size_t i, std::size_t j) const {
    return surface_.on[j] && surface_.normals[i].dot(surface_.normals[j]) > kBesideCos;
  }

  void take_nearest(std::size_t i) {
    near_.clear();
    for (const std::int32_t j : table_.of(i))
      if (j >= 0 && is_beside(i, static_cast<std::size_t>(j))) near_.push_back(j);
  }

  std::span<const Eigen::Vector3d> points_mm_;
  const NearestPoints& tree_;
  const NeighbourTable& table_;
  const SmoothSurface& surface_;
  const ContourOptions& options_;
  double disc_mm_;
  TouchFinder finder_;
  std::vector<std::int32_t> near_;
  std::vector<Neighbour> found_;
  std::vector<double> angles_;
};

/// Links the ends of open chains to starts, the nearest pairs first, where allowed(end, start, mm apart).
/// A chain, or a ring of chains, that meets itself becomes closed.
std::vector<FoundContour> linked(std::vector<FoundContour> loops, double reach_mm, const auto& allowed) {
  struct Link {
    double apart_mm;
    std::size_t end, start;
  };
  std::vector<FoundContour> result, open;
  for (FoundContour& loop : loops) (loop.contour.closed ? result : open).push_back(std::move(loop));
  std::vector<Link> links;
  for (std::size_t e = 0; e < open.size(); ++e)
    for (std::size_t s = 0; s < open.size(); ++s) {
      const Contour &from = open[e].contour, &to = open[s].contour;
      const double apart_mm = (to.points_mm.front() - from.points_mm.back()).norm();
      const bool too_short = e == s && from.points_mm.size() < kFewestClosed;
      if (apart_mm < reach_mm && !too_short && allowed(from, to, apart_mm)) links.push_back({apart_mm, e, s});
    }
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& a, const Link& b) { return a.apart_mm < b.apart_mm; });
  const std::size_t none = open.size();
  std::vector<std::size_t> next(open.size(), none), previous(open.size(), none);
  for (const Link& link : links)
    if (next[link.end] == none && previous[link.start] == none)
      next[link.end] = link.start, previous[link.start] = link.end;
  std::vector<char> done(open.size(), 0);
  const auto collect = [&](std::size_t first, bool closed) {
    FoundContour chain = std::move(open[first]);
    done[first] = 1;
    for (std::size_t at = next[first]; at != none && !done[at]; at = next[at]) {
      const Contour& tail = open[at].contour;
      chain.contour.points_mm.insert(chain.contour.points_mm.end(), tail.points_mm.begin(),
                                     tail.points_mm.end());
      chain.contour.normals.insert(chain.contour.normals.end(), tail.normals.begin(), tail.normals.end());
      done[at] = 1;
    }
    chain.contour.closed = closed;
    result.push_back(std::move(chain));
  };
  for (std::size_t c = 0; c < open.size(); ++c)
    if (previous[c] == none) collect(c, false);
  for (std::size_t c = 0; c < open.size(); ++c)
    if (!done[c]) collect(c, true);
  return result;
}

/// First what nearly touches, then long chains across a gap.
std::vector<FoundContour> joined(std::vector<FoundContour> loops, double spacing_mm) {
  loops = linked(std::move(loops), kJoinSpacings * spacing_mm,
                 [](const Contour&, const Contour&, double) { return true; });
  return linked(std::move(loops), kFarJoinSpacings * spacing_mm,
                [](const Contour& a, const Contour& b, double apart_mm) {
                  return apart_mm <= kFarJoinRatio * std::min(length_mm(a), length_mm(b));
                });
}

}  // namespace

std::vector<std::int32_t> boundary_points(std::span<const Eigen::Vector3d> points_mm,
                                          const NearestPoints& tree, const LocalPlanes& planes,
                                          const ContourOptions& options) {
  const NeighbourTable table = neighbour_table(points_mm, tree, options.threads);
  const SmoothSurface surface = smooth_surface(points_mm, table, planes, options.threads);
  std::vector<char> has_gap(points_mm.size(), 0);
  parallel_for(points_mm.size(), kChunk, options.threads, [&](std::size_t begin, std::size_t end) {
    Surroundings around(points_mm, tree, table, surface, options, 0.0);
    for (std::size_t i = begin; i < end; ++i) has_gap[i] = surface.on[i] && around.has_angle_gap(i) ? 1 : 0;
  });
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < has_gap.size(); ++i)
    if (has_gap[i]) found.push_back(static_cast<std::int32_t>(i));
  return found;
}

ContourSet cloud_contours(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                          const LocalPlanes& planes, const ContourOptions& options) {
  const NeighbourTable table = neighbour_table(points_mm, tree, options.threads);
  const SmoothSurface surface = smooth_surface(points_mm, table, planes, options.threads);
  const double disc_mm = options.disc_spacings_ratio * planes.spacing_median_mm;
  std::vector<std::vector<Node>> nodes_of(points_mm.size());
  parallel_for(points_mm.size(), kChunk, options.threads, [&](std::size_t begin, std::size_t end) {
    Surroundings around(points_mm, tree, table, surface, options, disc_mm);
    for (std::size_t i = begin; i < end; ++i) {
      if (!surface.on[i]) continue;
      const std::vector<Touch> touches = around.touches_of(i);
      const bool seed = !touches.empty() && around.has_angle_gap(i);
      for (const Touch& touch : touches) nodes_of[i].push_back({static_cast<std::int32_t>(i), seed, touch});
    }
  });
  std::vector<Node> nodes;
  for (const std::vector<Node>& of_point : nodes_of)
    nodes.insert(nodes.end(), of_point.begin(), of_point.end());
  const double shortest_mm =
      options.min_length_mm > 0.0 ? options.min_length_mm : kShortestSpacings * planes.spacing_median_mm;
  std::vector<FoundContour> loops = Walk(points_mm, surface.normals, std::move(nodes)).loops();
  loops = joined(std::move(loops), planes.spacing_median_mm);
  std::erase_if(loops, [](const FoundContour& loop) { return loop.contour.points_mm.size() < 2; });
  ContourSet set = measured(std::move(loops), shortest_mm, kRaggedBend);
  if (row_ratio(points_mm, table) > kRowsRatio)
    set.notes.push_back(
        "the points lie in rows, far denser along them than across: no surface is seen between rows; thin "
        "the "
        "scan to half the distance of its rows (voxel_mm)");
  return set;
}

}  // namespace arris
