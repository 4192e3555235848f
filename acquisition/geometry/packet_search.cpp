#include "acquisition/geometry/packet_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#pragma GCC diagnostic ignored \
    "-Wpsabi"  // vectors as arguments: of functions that become part of their caller

namespace arris::packet {
namespace {

// A squared distance is known to kUnsureRatio of itself and slack2 of the triangle: with a distance d known
// to
// +-(s + kShapeLimit d), (d +- s)^2 lies within d^2 (1 +- k) +- s^2 (1 + 1 / k).
constexpr float kUnsureRatio = 5e-3F;
constexpr double kShapeLimit = 1e-3;  // beyond it only the box of a sliver tells where it is
constexpr double kRoundings = 2e-6;   // 32 roundings of a float

// Vectors of GCC and Clang; two SSE registers or one AVX register each.
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Masks = std::int32_t __attribute__((vector_size(4 * kLanes)));

struct Walk {
  const BoxTree::Node* nodes;
  const Triangle* triangles;
  Queries& queries;
  Candidates& candidates;
};

// Every function below must become part of search_* to take its instructions.
#define ARRIS_INLINE [[gnu::always_inline]] inline

ARRIS_INLINE Floats larger(Floats a, Floats b) {
  return a > b ? a : b;
}
ARRIS_INLINE Floats smaller(Floats a, Floats b) {
  return a < b ? a : b;
}
ARRIS_INLINE Floats to_unit(Floats a) {
  return smaller(larger(a, Floats{}), Floats{} + 1.0F);
}

ARRIS_INLINE bool any(Masks mask) {
  using Wide = std::int64_t __attribute__((vector_size(4 * kLanes)));
  const Wide w = (Wide)mask;
  return (w[0] | w[1] | w[2] | w[3]) != 0;
}

ARRIS_INLINE Floats load(const float* values) {
  return *reinterpret_cast<const Floats*>(values);
}

struct Vectors {
  Floats x, y, z;
};
ARRIS_INLINE Floats dot(const Vectors& a, const float* b) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}
ARRIS_INLINE float dot(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Squared distance to the place t along an edge from the triangle's corner.
ARRIS_INLINE Floats to_edge2(const Vectors& from, const float* edge, float over_length2) {
  const Floats t = to_unit(dot(from, edge) * over_length2);
  const Floats x = from.x - t * edge[0], y = from.y - t * edge[1], z = from.z - t * edge[2];
  return x * x + y * y + z * z;
}

/// Squared distance to the plane inside the triangle, to the nearest edge outside: without branches.
ARRIS_INLINE Floats distance2(const Triangle& t, const Queries& q) {
  const Vectors ap{load(q.p_mm[0]) - t.a_mm[0], load(q.p_mm[1]) - t.a_mm[1], load(q.p_mm[2]) - t.a_mm[2]};
  const float bc[3] = {t.ac_mm[0] - t.ab_mm[0], t.ac_mm[1] - t.ab_mm[1], t.ac_mm[2] - t.ab_mm[2]};
  const Vectors bp{ap.x - t.ab_mm[0], ap.y - t.ab_mm[1], ap.z - t.ab_mm[2]};
  const Floats edges = smaller(smaller(to_edge2(ap, t.ab_mm, t.over_ab2), to_edge2(ap, t.ac_mm, t.over_ac2)),
                               to_edge2(bp, bc, t.over_bc2));
  const float normal[3] = {t.ab_mm[1] * t.ac_mm[2] - t.ab_mm[2] * t.ac_mm[1],
                           t.ab_mm[2] * t.ac_mm[0] - t.ab_mm[0] * t.ac_mm[2],
                           t.ab_mm[0] * t.ac_mm[1] - t.ab_mm[1] * t.ac_mm[0]};
  const float ab2 = dot(t.ab_mm, t.ab_mm), ac2 = dot(t.ac_mm, t.ac_mm), abac = dot(t.ab_mm, t.ac_mm);
  const Floats d1 = dot(ap, t.ab_mm), d2 = dot(ap, t.ac_mm);
  const Floats v = (d1 * ac2 - d2 * abac) * t.over_area2, w = (d2 * ab2 - d1 * abac) * t.over_area2;
  const Floats height = dot(ap, normal);
  const Masks inside = (v >= 0.0F) & (w >= 0.0F) & (v + w <= 1.0F);
  return inside ? height * height * t.over_area2 : edges;
}

/// Drops from a full list what has fallen out of the limit.
ARRIS_INLINE void make_room(Candidates& list, int lane, float limit2) {
  int kept = 0;
  for (int k = 0; k < list.count[lane]; ++k) {
    if (list.least2_mm2[lane][k] > limit2) continue;
    list.item[lane][kept] = list.item[lane][k];
    list.least2_mm2[lane][kept++] = list.least2_mm2[lane][k];
  }
  list.count[lane] = kept == kMostCandidates ? -1 : kept;
}

ARRIS_INLINE void look_at(const Walk& walk, std::int32_t item, Floats box2) {
  const Triangle& t = walk.triangles[item];
  const bool sliver = !(t.slack2_mm2 < std::numeric_limits<float>::max());
  Floats& limit2 = *reinterpret_cast<Floats*>(walk.queries.limit2_mm2);
  Floats least2 = box2;
  if (!sliver) {
    const Floats d2 = distance2(t, walk.queries);
    least2 = d2 * (1.0F - kUnsureRatio) - t.slack2_mm2;
    limit2 = smaller(limit2, d2 * (1.0F + kUnsureRatio) + t.slack2_mm2);
  }
  const Masks within = least2 <= limit2;
  if (!any(within)) return;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (within[lane] == 0 || walk.candidates.count[lane] < 0) continue;
    if (walk.candidates.count[lane] == kMostCandidates) make_room(walk.candidates, lane, limit2[lane]);
    const int k = walk.candidates.count[lane];
    if (k < 0) continue;
    walk.candidates.item[lane][k] = item;
    walk.candidates.least2_mm2[lane][k] = least2[lane];
    ++walk.candidates.count[lane];
  }
}

struct Open {
  Floats box2;
  std::int32_t child;
};

ARRIS_INLINE void walk_down(const Walk& walk, std::int32_t near_item) {
  if (near_item >= 0) look_at(walk, near_item, Floats{});
  const Floats x = load(walk.queries.p_mm[0]), y = load(walk.queries.p_mm[1]), z = load(walk.queries.p_mm[2]);
  Open stack[BoxTree::kMostOpen];
  std::size_t open = 0;
  stack[open++] = {Floats{}, 0};
  while (open > 0) {
    const Open at = stack[--open];
    if (!any(at.box2 <= load(walk.queries.limit2_mm2))) continue;
    if (at.child < 0) {
      if (-1 - at.child != near_item) look_at(walk, -1 - at.child, at.box2);
      continue;
    }
    const BoxTree::Node& node = walk.nodes[at.child];
    const Floats limit2 = load(walk.queries.limit2_mm2);
    std::size_t nearest = open;
    for (std::size_t k = 0; k < BoxTree::kWidth; ++k) {
      if (node.child[k] == BoxTree::kNone) continue;
      const Floats dx = larger(larger(node.low_mm[0][k] - x, x - node.high_mm[0][k]), Floats{});
      const Floats dy = larger(larger(node.low_mm[1][k] - y, y - node.high_mm[1][k]), Floats{});
      const Floats dz = larger(larger(node.low_mm[2][k] - z, z - node.high_mm[2][k]), Floats{});
      const Floats box2 = dx * dx + dy * dy + dz * dz;
      if (!any(box2 <= limit2)) continue;
      stack[open] = {box2, node.child[k]};
      if (box2[0] < stack[nearest].box2[0]) nearest = open;
      ++open;
    }
    if (nearest + 1 < open) std::swap(stack[nearest], stack[open - 1]);
  }
}

#undef ARRIS_INLINE

void search_plain(const Walk& walk, std::int32_t near_item) {
  walk_down(walk, near_item);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void search_avx2(const Walk& walk, std::int32_t near_item) {
  walk_down(walk, near_item);
}
#endif

using Search = void (*)(const Walk&, std::int32_t);

Search best_search() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return search_avx2;
#endif
  return search_plain;
}

}  // namespace

Triangle triangle_of(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm, const Eigen::Vector3d& c_mm,
                     double slack_mm) {
  const Eigen::Vector3d ab = b_mm - a_mm, ac = c_mm - a_mm, bc = c_mm - b_mm;
  const double area2 = ab.cross(ac).squaredNorm();  // of the parallelogram, squared
  const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
  Triangle t{};
  for (int axis = 0; axis < 3; ++axis) {
    t.a_mm[axis] = static_cast<float>(a_mm[axis]);
    t.ab_mm[axis] = static_cast<float>(ab[axis]);
    t.ac_mm[axis] = static_cast<float>(ac[axis]);
  }
  t.over_ab2 = static_cast<float>(1.0 / ab.squaredNorm());
  t.over_ac2 = static_cast<float>(1.0 / ac.squaredNorm());
  t.over_bc2 = static_cast<float>(1.0 / bc.squaredNorm());
  t.over_area2 = static_cast<float>(1.0 / area2);
  // Which side of an edge a foot lies on is unsure by roundings times (longest / height)^2.
  const double shape = kRoundings * longest2 * longest2 / area2;
  const double slack = slack_mm + 2.0 * shape * std::sqrt(longest2);
  const bool told = shape < kShapeLimit && area2 > 1e-30 && longest2 < 1e18;
  t.slack2_mm2 = told ? static_cast<float>(slack * slack * (1.0 + 2.0 / kUnsureRatio))
                      : std::numeric_limits<float>::infinity();
  return t;
}

void search(const BoxTree& tree, const Triangle* triangles, std::int32_t near_item, Queries& queries,
            Candidates& candidates) {
  static const Search run = best_search();
  std::fill_n(candidates.count, kLanes, 0);
  if (tree.nodes().empty()) return;
  run({tree.nodes().data(), triangles, queries, candidates}, near_item);
}

}  // namespace arris::packet
