#include "acquisition/geometry/packet_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "acquisition/geometry/registers.hpp"

#pragma GCC diagnostic ignored \
    "-Wpsabi"  // vectors as arguments: of functions that become part of their caller

namespace arris::packet {
namespace {

// A squared distance is known to kUnsureRatio of itself and slack2 of the triangle: with a distance d known
// to +-(s + kShapeLimit d), (d +- s)^2 lies within d^2 (1 +- k) +- s^2 (1 + 1 / k).
constexpr float kUnsureRatio = 5e-3F;
constexpr double kShapeLimit = 1e-3;  // of a thinner sliver float does not tell what lies inside
constexpr double kRoundings = 2e-6;   // 32 roundings of a float
constexpr float kGuessRatio = 2.0F, kGuessKept = 0.8F;

using NodeFloats = float __attribute__((vector_size(4 * BoxTree::kWidth)));
using NodeMasks = std::int32_t __attribute__((vector_size(4 * BoxTree::kWidth)));

struct Search {
  const BoxTree::Node* nodes;
  const Triangle* triangles;
  Queries& queries;
  Candidates& candidates;
};

template <class Vector>
ARRIS_INLINE Vector larger(Vector a, Vector b) {
  return a > b ? a : b;
}
template <class Vector>
ARRIS_INLINE Vector smaller(Vector a, Vector b) {
  return a < b ? a : b;
}

ARRIS_INLINE const NodeFloats& node_side(const float* values) {
  return *reinterpret_cast<const NodeFloats*>(values);
}

/// Lists the triangles whose boxes come within the limit of the box of the queries; false: too many.
ARRIS_INLINE bool list(const Search& search, const float* low_mm, const float* high_mm, float limit2_mm2) {
  std::int32_t stack[BoxTree::kMostOpen];
  std::size_t open = 1;
  stack[0] = 0;
  int count = 0;
  while (open > 0) {
    const BoxTree::Node& node = search.nodes[stack[--open]];
    NodeFloats box2{};
    for (int axis = 0; axis < 3; ++axis) {
      const NodeFloats off = larger(
          larger(node_side(node.low_mm[axis]) - high_mm[axis], low_mm[axis] - node_side(node.high_mm[axis])),
          NodeFloats{});
      box2 += off * off;
    }
    const NodeMasks within = box2 <= limit2_mm2;
    if (count > kMostTriangles - static_cast<int>(BoxTree::kWidth)) return false;
    for (std::size_t k = 0; k < BoxTree::kWidth; ++k) {  // without branches: nothing foretells them
      const std::int32_t child = node.child[k];
      const bool is_item = child < 0;
      stack[open] = child;
      open += static_cast<std::size_t>(within[k] != 0 && !is_item);
      search.candidates.place[count] = -1 - child;
      count += static_cast<int>(within[k] != 0 && is_item);
    }
  }
  search.candidates.count = count;
  return true;
}

/// Vectors of GCC and Clang, as wide as a register of the CPU.
template <int kWide>
struct Wide {
  using Floats = typename registers::Of<4 * kWide>::Floats;
  using Masks = typename registers::Of<4 * kWide>::Ints;

  ARRIS_INLINE static Floats& at(float* values) { return *reinterpret_cast<Floats*>(values); }

  /// Squared distance in the plane from a side that begins at the place `along` counts from.
  ARRIS_INLINE static Floats to_side2(Floats along, Floats across, float length_mm) {
    const Floats past = along - smaller(larger(along, Floats{}), Floats{} + length_mm);
    return past * past + across * across;
  }

  /// Squared distance in the triangle's frame: height, and the nearest side for what lies outside all three.
  ARRIS_INLINE static Floats distance2(const Triangle& t, const Floats& px, const Floats& py,
                                       const Floats& pz) {
    const Floats dx = px - t.origin_mm[0], dy = py - t.origin_mm[1], dz = pz - t.origin_mm[2];
    const Floats x = dx * t.along[0] + dy * t.along[1] + dz * t.along[2];
    const Floats y = dx * t.across[0] + dy * t.across[1] + dz * t.across[2];
    const Floats height = dx * t.normal[0] + dy * t.normal[1] + dz * t.normal[2];
    const Floats along2 = x * t.second_along[0] + y * t.second_along[1] - t.second_start[0];
    const Floats inward2 = y * t.second_along[0] - x * t.second_along[1] - t.second_start[1];
    const Floats along3 = x * t.third_along[0] + y * t.third_along[1] + t.third_length_mm;
    const Floats inward3 = y * t.third_along[0] - x * t.third_along[1];
    const Floats sides2 =
        smaller(smaller(to_side2(x, y, t.length_mm), to_side2(along2, inward2, t.second_length_mm)),
                to_side2(along3, inward3, t.third_length_mm));
    const Masks inside = smaller(smaller(y, inward2), inward3) >= 0.0F;
    return (inside ? Floats{} : sides2) + height * height;
  }

  /// Measures what is listed to the queries from `first` on.
  ARRIS_INLINE static void measure(const Search& search, int first) {
    const Floats x = at(search.queries.p_mm[0] + first), y = at(search.queries.p_mm[1] + first),
                 z = at(search.queries.p_mm[2] + first);
    Floats limit2 = at(search.queries.limit2_mm2 + first);
    for (int k = 0; k < search.candidates.count; ++k) {
      const Triangle& t = search.triangles[search.candidates.place[k]];
      const Floats d2 = distance2(t, x, y, z);
      at(search.candidates.least2_mm2[k] + first) = d2 * (1.0F - kUnsureRatio) - t.slack2_mm2;
      limit2 = smaller(limit2, d2 * (1.0F + kUnsureRatio) + t.slack2_mm2);
    }
    at(search.queries.limit2_mm2 + first) = limit2;
  }

  /// Returns the largest limit left.
  ARRIS_INLINE static float measure(const Search& search) {
    for (int first = 0; first < kLanes; first += kWide) measure(search, first);
    return largest(search.queries.limit2_mm2);
  }

  ARRIS_INLINE static float largest(float* values) {
    Floats most = at(values);
    for (int first = kWide; first < kLanes; first += kWide) most = larger(most, at(values + first));
    float one = most[0];
    for (int k = 1; k < kWide; ++k) one = std::max(one, most[k]);
    return one;
  }
  ARRIS_INLINE static float least(float* values) {
    Floats few = at(values);
    for (int first = kWide; first < kLanes; first += kWide) few = smaller(few, at(values + first));
    float one = few[0];
    for (int k = 1; k < kWide; ++k) one = std::min(one, few[k]);
    return one;
  }

  ARRIS_INLINE static void mark(const Search& search) {
    int kept = 0;
    for (int k = 0; k < search.candidates.count; ++k) {
      unsigned lanes = 0;
      for (int first = 0; first < kLanes; first += kWide) {
        const Masks within =
            (at(search.candidates.least2_mm2[k] + first) <= at(search.queries.limit2_mm2 + first));
        for (int lane = 0; lane < kWide; ++lane)
          lanes |= (static_cast<unsigned>(within[lane]) & 1U) << static_cast<unsigned>(first + lane);
      }
      search.candidates.place[kept] = search.candidates.place[k];
      search.candidates.lanes[kept] = lanes;
      kept += static_cast<int>(lanes != 0);
    }
    search.candidates.count = kept;
  }

  ARRIS_INLINE static bool run(const Search& search, std::int32_t near_place, float& guess2_mm2) {
    float low_mm[3], high_mm[3];
    for (int axis = 0; axis < 3; ++axis) {
      low_mm[axis] = least(search.queries.p_mm[axis]);
      high_mm[axis] = largest(search.queries.p_mm[axis]);
    }
    const float tried2_mm2 = guess2_mm2;
    if (!list(search, low_mm, high_mm, tried2_mm2)) return false;
    if (search.candidates.count == 0 && near_place >= 0) {
      search.candidates.count = 1;
      search.candidates.place[0] = near_place;
    }
    float most2_mm2 = measure(search);
    if (most2_mm2 > tried2_mm2) {  // what was found bounds it
      if (!list(search, low_mm, high_mm, most2_mm2)) return false;
      most2_mm2 = measure(search);
    }
    guess2_mm2 = std::max(kGuessRatio * most2_mm2, kGuessKept * guess2_mm2);
    mark(search);
    return true;
  }
};

bool search_plain(const Search& search, std::int32_t near_place, float& guess2_mm2) {
  return Wide<4>::run(search, near_place, guess2_mm2);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] bool search_avx2(const Search& search, std::int32_t near_place, float& guess2_mm2) {
  return Wide<8>::run(search, near_place, guess2_mm2);
}
#endif

using Run = bool (*)(const Search&, std::int32_t, float&);

Run best_search() {
#if defined(__x86_64__)
  if (registers::has_avx2()) return search_avx2;
#endif
  return search_plain;
}

}  // namespace

Triangle triangle_of(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm, const Eigen::Vector3d& c_mm,
                     double slack_mm) {
  std::array<Eigen::Vector3d, 3> p = {a_mm, b_mm, c_mm};
  const double ab2 = (b_mm - a_mm).squaredNorm(), bc2 = (c_mm - b_mm).squaredNorm(),
               ca2 = (a_mm - c_mm).squaredNorm();
  if (bc2 >= ab2 && bc2 >= ca2) p = {b_mm, c_mm, a_mm};
  if (ca2 > ab2 && ca2 > bc2) p = {c_mm, a_mm, b_mm};
  const double length_mm = (p[1] - p[0]).norm();
  const Eigen::Vector3d along = (p[1] - p[0]) / length_mm;
  const Eigen::Vector3d cross = along.cross(p[2] - p[0]);
  const double height_mm = cross.norm();
  const Eigen::Vector3d normal = cross / height_mm, across = normal.cross(along);
  const Eigen::Vector2d end(length_mm, 0.0), top(along.dot(p[2] - p[0]), height_mm);
  const Eigen::Vector2d second = (top - end).normalized(), third = (-top).normalized();
  // What lies outside two sides by a rounding lies beyond their corner by 2 / its angle as much.
  const double shape = kRoundings * 2.0 * length_mm / height_mm;
  const double slack = slack_mm + 2.0 * shape * length_mm;
  Triangle t{};
  t.slack2_mm2 = std::numeric_limits<float>::infinity();
  if (!(shape < kShapeLimit && height_mm > 1e-15 && length_mm < 1e9)) return t;
  t.slack2_mm2 = static_cast<float>(slack * slack * (1.0 + 2.0 / kUnsureRatio));
  for (int axis = 0; axis < 3; ++axis) {
    t.origin_mm[axis] = static_cast<float>(p[0][axis]);
    t.along[axis] = static_cast<float>(along[axis]);
    t.across[axis] = static_cast<float>(across[axis]);
    t.normal[axis] = static_cast<float>(normal[axis]);
  }
  t.length_mm = static_cast<float>(length_mm);
  for (int k = 0; k < 2; ++k) {
    t.second_along[k] = static_cast<float>(second[k]);
    t.third_along[k] = static_cast<float>(third[k]);
  }
  t.second_start[0] = static_cast<float>(end.x() * second.x());
  t.second_start[1] = static_cast<float>(-end.x() * second.y());
  t.second_length_mm = static_cast<float>((top - end).norm());
  t.third_length_mm = static_cast<float>(top.norm());
  return t;
}

bool search(const BoxTree& tree, const Triangle* triangles, std::int32_t near_place, float& guess2_mm2,
            Queries& queries, Candidates& candidates) {
  static const Run run = best_search();
  candidates.count = 0;
  if (tree.nodes().empty()) return true;
  return run({tree.nodes().data(), triangles, queries, candidates}, near_place, guess2_mm2);
}

}  // namespace arris::packet
