#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "acquisition/contour_extract.hpp"
#include "acquisition/contour_set.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {
namespace {

constexpr int kGapNeighbours = 12;
constexpr double kOffSurfaceSigmas =
    4.0;  // points of the cut's wall and strays stand off their neighbours' plane
constexpr double kOffSurfaceSpacings = 0.06;
constexpr double kJoinSpacings = 4.0;  // ends of broken chains no farther apart than this belong together,
constexpr double kFarJoinSpacings = 12.0;  // or than this if both chains are long beside the gap
constexpr double kFarJoinRatio = 0.1;
constexpr std::size_t kFewestClosed = 8;    // a chain of fewer points is not closed
constexpr double kShortestSpacings = 20.0;  // shorter loops are voids of the sampling
constexpr std::size_t kChunk = 256;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

double positive_angle(double angle_rad) {
  return angle_rad < 0.0 ? angle_rad + kTwoPi : angle_rad;
}

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

  std::vector<Touch> touches_of(std::size_t i, const std::vector<std::int32_t>& near) {
    const Eigen::Matrix3d frame = frame_with_z(normals_[i]);
    blocked_.clear();
    for (const std::int32_t index : near) {
      const Eigen::Vector3d d = points_mm_[static_cast<std::size_t>(index)] - points_mm_[i];
      const double x = frame.col(0).dot(d), y = frame.col(1).dot(d);
      const double distance_mm = std::hypot(x, y);
      if (distance_mm <= 0.0 || distance_mm >= 2.0 * disc_mm_) continue;
      const double half = std::acos(distance_mm / (2.0 * disc_mm_));
      const double from = positive_angle(std::remainder(std::atan2(y, x) - half, kTwoPi));
      blocked_.push_back({from, from + 2.0 * half, index});
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

  std::span<const Eigen::Vector3d> points_mm_;
  const std::vector<Eigen::Vector3d>& normals_;
  double disc_mm_;
  std::vector<Blocked> blocked_;
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

  std::vector<FoundContour> loops() const {
    std::vector<std::int32_t> next(nodes_.size(), -1);
    for (std::size_t n = 0; n < nodes_.size(); ++n) next[n] = successor(nodes_[n]);
    std::vector<char> state(nodes_.size(), 0);  // 0 new, 1 on this walk, 2 done
    std::vector<FoundContour> found;
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (nodes_[n].seed) collect(static_cast<std::int32_t>(n), next, state, found);
    return found;
  }

 private:
  /// At the next point, the touch that the disc arrives in: stopped by this point, or else the nearest
  /// direction.
  std::int32_t successor(const Node& node) const {
    const std::size_t to = static_cast<std::size_t>(node.touch.after);
    std::int32_t best = -1;
    double best_mismatch = 1e300;
    for (std::size_t k = first_[to]; k < first_[to + 1]; ++k) {
      const double mismatch =
          nodes_[k].touch.before == node.point ? -1.0 : direction_mismatch(node, nodes_[k]);
      if (mismatch < best_mismatch) best_mismatch = mismatch, best = static_cast<std::int32_t>(k);
    }
    return best_mismatch < 1.0 ? best : -1;
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

  void collect(std::int32_t start, const std::vector<std::int32_t>& next, std::vector<char>& state,
               std::vector<FoundContour>& found) const {
    std::vector<std::int32_t> walk;
    std::int32_t n = start;
    while (n >= 0 && state[static_cast<std::size_t>(n)] == 0) {
      state[static_cast<std::size_t>(n)] = 1;
      walk.push_back(n);
      n = next[static_cast<std::size_t>(n)];
    }
    auto tail_end = walk.cend();
    if (n >= 0 && state[static_cast<std::size_t>(n)] == 1) {  // closed upon itself, perhaps after a tail
      tail_end = std::find(walk.cbegin(), walk.cend(), n);
      found.push_back(contour_of(tail_end, walk.cend(), true));
    }
    if (tail_end - walk.cbegin() > 1) found.push_back(contour_of(walk.cbegin(), tail_end, false));
    for (const std::int32_t visited : walk) state[static_cast<std::size_t>(visited)] = 2;
  }

  FoundContour contour_of(std::vector<std::int32_t>::const_iterator begin,
                          std::vector<std::int32_t>::const_iterator end, bool closed) const {
    FoundContour found;
    found.contour.closed = closed;
    found.contour.source = "angle gap";
    for (auto n = begin; n != end; ++n) {
      const std::size_t point = static_cast<std::size_t>(nodes_[static_cast<std::size_t>(*n)].point);
      found.contour.points_mm.push_back(points_mm_[point]);
      found.contour.normals.push_back(normals_[point]);
    }
    return found;
  }

  std::span<const Eigen::Vector3d> points_mm_;
  const std::vector<Eigen::Vector3d>& normals_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> first_;  // nodes of point i: first_[i] .. first_[i + 1]
};

/// The 12 nearest of every point (without itself), kept because four steps look at them.
std::vector<std::int32_t> neighbour_table(std::span<const Eigen::Vector3d> points_mm,
                                          const NearestPoints& tree, int threads) {
  std::vector<std::int32_t> table(points_mm.size() * kGapNeighbours, -1);
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points_mm[i], kGapNeighbours + 1, near);
      std::size_t k = 0;
      for (const Neighbour& neighbour : near)
        if (neighbour.index != static_cast<std::int32_t>(i) && k < kGapNeighbours)
          table[i * kGapNeighbours + k++] = neighbour.index;
    }
  });
  return table;
}

double median_in_place(std::array<double, kGapNeighbours>& values, std::size_t count) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count / 2),
                   values.begin() + static_cast<std::ptrdiff_t>(count));
  return values[count / 2];
}

/// Component-wise median of the neighbours' normals: wall points beside an edge do not tilt it.
Eigen::Vector3d median_normal(std::size_t i, std::span<const std::int32_t> near, const LocalPlanes& planes) {
  Eigen::Vector3d normal = planes.normals[i];
  std::array<double, kGapNeighbours> values{};
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t count = 0;
    for (const std::int32_t j : near)
      if (j >= 0) values[count++] = planes.normals[static_cast<std::size_t>(j)][axis];
    if (count > 0) normal[axis] = median_in_place(values, count);
  }
  return normal.norm() > 0.1 ? Eigen::Vector3d(normal.normalized()) : planes.normals[i];
}

/// The part of the cloud that is one smooth surface, with its normals.
struct Surface {
  std::vector<Eigen::Vector3d> normals;
  std::vector<char> on;
};

Surface smooth_surface(std::span<const Eigen::Vector3d> points_mm, const std::vector<std::int32_t>& table,
                       const LocalPlanes& planes, int threads) {
  Surface surface{std::vector<Eigen::Vector3d>(points_mm.size()), std::vector<char>(points_mm.size(), 1)};
  const double gate_mm =
      std::max(kOffSurfaceSigmas * planes.noise_sigma_mm, kOffSurfaceSpacings * planes.spacing_median_mm);
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    std::array<double, kGapNeighbours> heights{};
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<const std::int32_t> near(&table[i * kGapNeighbours], kGapNeighbours);
      surface.normals[i] = median_normal(i, near, planes);
      std::size_t count = 0;
      for (const std::int32_t j : near)
        if (j >= 0)
          heights[count++] = surface.normals[i].dot(points_mm[static_cast<std::size_t>(j)] - points_mm[i]);
      surface.on[i] = count > 0 && std::abs(median_in_place(heights, count)) < gate_mm ? 1 : 0;
    }
  });
  return surface;
}

/// Looks at one point's neighbours on the surface; scratch that one thread reuses.
class Surroundings {
 public:
  Surroundings(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
               const std::vector<std::int32_t>& table, const Surface& surface, const ContourOptions& options,
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
    if (finder_.touches_of(i, near_).empty() && near_.size() > 1) return {};
    tree_.within(points_mm_[i], 2.0 * disc_mm_, found_);
    near_.clear();
    for (const Neighbour& n : found_)
      if (surface_.on[static_cast<std::size_t>(n.index)]) near_.push_back(n.index);
    return finder_.touches_of(i, near_);
  }

 private:
  void take_nearest(std::size_t i) {
    near_.clear();
    for (const std::int32_t j : std::span(&table_[i * kGapNeighbours], kGapNeighbours))
      if (j >= 0 && surface_.on[static_cast<std::size_t>(j)]) near_.push_back(j);
  }

  std::span<const Eigen::Vector3d> points_mm_;
  const NearestPoints& tree_;
  const std::vector<std::int32_t>& table_;
  const Surface& surface_;
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
  const std::vector<std::int32_t> table = neighbour_table(points_mm, tree, options.threads);
  const Surface surface = smooth_surface(points_mm, table, planes, options.threads);
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
  const std::vector<std::int32_t> table = neighbour_table(points_mm, tree, options.threads);
  const Surface surface = smooth_surface(points_mm, table, planes, options.threads);
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
  return measured(joined(std::move(loops), planes.spacing_median_mm), shortest_mm);
}

}  // namespace arris
