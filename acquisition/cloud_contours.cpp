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
constexpr double kOffSurfaceSigmas = 4.0;   // points of the cut's wall and strays stand off their neighbours' plane
constexpr double kOffSurfaceSpacings = 0.06;
constexpr double kJoinSpacings = 4.0;       // ends of broken chains no farther apart than this belong together,
constexpr double kFarJoinSpacings = 12.0;   // or than this if both chains are long beside the gap
constexpr double kFarJoinRatio = 0.1;
constexpr double kShortestSpacings = 20.0;  // shorter loops are voids of the sampling
constexpr std::size_t kChunk = 256;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

double positive_angle(double angle_rad) { return angle_rad < 0.0 ? angle_rad + kTwoPi : angle_rad; }

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

/// A direction in which the empty disc can touch a point, between two neighbours that stop it. With the material on
/// the left of the walk, the walk arrives from `before` and leaves to `after`.
struct Touch {
  std::int32_t before = -1, after = -1;
  double from_rad = 0.0, to_rad = 0.0;  // directions of the disc's centre, counter-clockwise
  double gap_rad = 0.0;
};

/// All free directions of a disc of radius r at a point: each neighbour at distance d blocks phi +- acos(d / 2r).
std::vector<Touch> touches_of(const Eigen::Vector3d& p, const Eigen::Matrix3d& frame, double disc_mm,
                              std::span<const Eigen::Vector3d> points_mm, const std::vector<Neighbour>& near) {
  struct Blocked {
    double from, to;
    std::int32_t index;
  };
  std::vector<Blocked> blocked;
  for (const Neighbour& neighbour : near) {
    const Eigen::Vector3d d = points_mm[static_cast<std::size_t>(neighbour.index)] - p;
    const double x = frame.col(0).dot(d), y = frame.col(1).dot(d);
    const double distance_mm = std::hypot(x, y);
    if (distance_mm <= 0.0 || distance_mm >= 2.0 * disc_mm) continue;
    const double half = std::acos(distance_mm / (2.0 * disc_mm));
    const double from = positive_angle(std::remainder(std::atan2(y, x) - half, kTwoPi));
    blocked.push_back({from, from + 2.0 * half, neighbour.index});
  }
  std::sort(blocked.begin(), blocked.end(), [](const Blocked& a, const Blocked& b) { return a.from < b.from; });
  std::vector<Touch> touches;
  if (blocked.size() < 2) return touches;
  // Sweep twice around, so that what is blocked across zero counts.
  double reach = -1.0;
  std::int32_t holder = -1;
  for (int turn = 0; turn < 2; ++turn)
    for (const Blocked& b : blocked) {
      const double from = b.from + turn * kTwoPi, to = b.to + turn * kTwoPi;
      if (holder >= 0 && turn == 1 && from > reach) touches.push_back({holder, b.index, reach, from, from - reach});
      if (to > reach) reach = to, holder = b.index;
    }
  return touches;
}

struct Node {
  std::int32_t point = -1;
  Touch touch;
};

/// Rolls the disc from touch to touch.
class Walk {
 public:
  Walk(std::span<const Eigen::Vector3d> points_mm, const std::vector<Eigen::Vector3d>& normals, std::vector<Node> nodes)
      : points_mm_(points_mm), normals_(normals), nodes_(std::move(nodes)), first_(points_mm.size() + 1, 0) {
    for (const Node& node : nodes_) ++first_[static_cast<std::size_t>(node.point) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  }

  std::vector<FoundContour> loops() const {
    std::vector<std::int32_t> next(nodes_.size(), -1);
    for (std::size_t n = 0; n < nodes_.size(); ++n) next[n] = successor(nodes_[n]);
    std::vector<char> state(nodes_.size(), 0);  // 0 new, 1 on this walk, 2 done
    std::vector<FoundContour> found;
    for (std::size_t n = 0; n < nodes_.size(); ++n) collect(static_cast<std::int32_t>(n), next, state, found);
    return found;
  }

 private:
  /// At the next point, the touch that the disc arrives in: stopped by this point, or else the nearest direction.
  std::int32_t successor(const Node& node) const {
    const std::size_t to = static_cast<std::size_t>(node.touch.after);
    std::int32_t best = -1;
    double best_mismatch = 1e300;
    for (std::size_t k = first_[to]; k < first_[to + 1]; ++k) {
      const double mismatch = nodes_[k].touch.before == node.point ? -1.0 : direction_mismatch(node, nodes_[k]);
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

}  // namespace

namespace {

/// The 12 nearest of every point (without itself), kept because four steps look at them.
std::vector<std::int32_t> neighbour_table(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                                          int threads) {
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
        if (j >= 0) heights[count++] = surface.normals[i].dot(points_mm[static_cast<std::size_t>(j)] - points_mm[i]);
      surface.on[i] = count > 0 && std::abs(median_in_place(heights, count)) < gate_mm ? 1 : 0;
    }
  });
  return surface;
}

std::vector<std::int32_t> gap_points(std::span<const Eigen::Vector3d> points_mm, const std::vector<std::int32_t>& table,
                                     const Surface& surface, const ContourOptions& options) {
  std::vector<char> is_boundary(points_mm.size(), 0);
  parallel_for(points_mm.size(), kChunk, options.threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::int32_t> near;
    std::vector<double> angles;
    for (std::size_t i = begin; i < end; ++i) {
      if (!surface.on[i]) continue;
      near.clear();
      for (std::size_t k = 0; k < kGapNeighbours; ++k) {
        const std::int32_t j = table[i * kGapNeighbours + k];
        if (j >= 0 && surface.on[static_cast<std::size_t>(j)]) near.push_back(j);
      }
      const Eigen::Matrix3d frame = frame_with_z(surface.normals[i]);
      is_boundary[i] = largest_gap_rad(points_mm[i], frame, points_mm, near, angles) > options.angle_gap_rad ? 1 : 0;
    }
  });
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < is_boundary.size(); ++i)
    if (is_boundary[i]) found.push_back(static_cast<std::int32_t>(i));
  return found;
}

/// Joins open chains end to start, the nearest pairs first, and closes a chain whose own ends are near.
std::vector<FoundContour> joined(std::vector<FoundContour> loops, double spacing_mm) {
  const double join_mm = kFarJoinSpacings * spacing_mm;
  std::vector<FoundContour> closed, open;
  for (FoundContour& loop : loops) (loop.contour.closed ? closed : open).push_back(std::move(loop));
  for (;;) {
    double best_mm = join_mm;
    std::size_t best_end = 0, best_start = 0;
    for (std::size_t e = 0; e < open.size(); ++e)
      for (std::size_t s = 0; s < open.size(); ++s) {
        if (open[e].contour.points_mm.empty() || open[s].contour.points_mm.empty()) continue;
        const double apart = (open[s].contour.points_mm.front() - open[e].contour.points_mm.back()).norm();
        const bool too_short = e == s && open[e].contour.points_mm.size() < 8;
        const bool too_far = apart > kJoinSpacings * spacing_mm &&
                             apart > kFarJoinRatio * std::min(length_mm(open[e].contour), length_mm(open[s].contour));
        if (apart < best_mm && !too_short && !too_far) best_mm = apart, best_end = e, best_start = s;
      }
    if (best_mm >= join_mm) break;
    FoundContour& chain = open[best_end];
    if (best_end == best_start) {
      chain.contour.closed = true;
      closed.push_back(std::move(chain));
    } else {
      const Contour& tail = open[best_start].contour;
      chain.contour.points_mm.insert(chain.contour.points_mm.end(), tail.points_mm.begin(), tail.points_mm.end());
      chain.contour.normals.insert(chain.contour.normals.end(), tail.normals.begin(), tail.normals.end());
    }
    const std::size_t gone = best_start;
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(gone));
  }
  closed.insert(closed.end(), std::make_move_iterator(open.begin()), std::make_move_iterator(open.end()));
  return closed;
}

}  // namespace

std::vector<std::int32_t> boundary_points(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                                          const LocalPlanes& planes, const ContourOptions& options) {
  const std::vector<std::int32_t> table = neighbour_table(points_mm, tree, options.threads);
  return gap_points(points_mm, table, smooth_surface(points_mm, table, planes, options.threads), options);
}

ContourSet cloud_contours(std::span<const Eigen::Vector3d> points_mm, const NearestPoints& tree,
                          const LocalPlanes& planes, const ContourOptions& options) {
  const std::vector<std::int32_t> table = neighbour_table(points_mm, tree, options.threads);
  const Surface surface = smooth_surface(points_mm, table, planes, options.threads);
  const std::vector<std::int32_t> candidates = gap_points(points_mm, table, surface, options);
  const double disc_mm = options.disc_spacings_ratio * planes.spacing_median_mm;
  std::vector<std::vector<Touch>> touches(candidates.size());
  parallel_for(candidates.size(), kChunk, options.threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> near;
    for (std::size_t c = begin; c < end; ++c) {
      const std::size_t i = static_cast<std::size_t>(candidates[c]);
      tree.within(points_mm[i], 2.0 * disc_mm, near);
      std::erase_if(near, [&](const Neighbour& n) { return !surface.on[static_cast<std::size_t>(n.index)]; });
      touches[c] = touches_of(points_mm[i], frame_with_z(surface.normals[i]), disc_mm, points_mm, near);
    }
  });
  std::vector<Node> nodes;
  for (std::size_t c = 0; c < candidates.size(); ++c)
    for (const Touch& touch : touches[c]) nodes.push_back({candidates[c], touch});
  const double shortest_mm =
      options.min_length_mm > 0.0 ? options.min_length_mm : kShortestSpacings * planes.spacing_median_mm;
  std::vector<FoundContour> loops = Walk(points_mm, surface.normals, std::move(nodes)).loops();
  return measured(joined(std::move(loops), planes.spacing_median_mm), shortest_mm);
}

}  // namespace arris
