#include "acquisition/geometry/packet_feet.hpp"

#include <algorithm>

#include "acquisition/geometry/registers.hpp"

#pragma GCC diagnostic ignored \
    "-Wpsabi"  // vectors as arguments: of functions that become part of their caller

namespace arris::packet {
namespace {

template <int kWide>
struct Wide {
  using Doubles = typename registers::Of<8 * kWide>::Doubles;
  using Masks = typename registers::Of<8 * kWide>::Longs;

  ARRIS_INLINE static Doubles& at(double* values) { return *reinterpret_cast<Doubles*>(values); }

  struct Vectors {
    Doubles x, y, z;
  };
  // In the order in which Eigen adds: the same bits.
  ARRIS_INLINE static Doubles dot(const Vectors& a, const Eigen::Vector3d& b) {
    return a.x * b.x() + a.y * b.y() + a.z * b.z();
  }
  ARRIS_INLINE static Vectors less(const Vectors& a, const Eigen::Vector3d& b) {
    return {a.x - b.x(), a.y - b.y(), a.z - b.z()};
  }
  ARRIS_INLINE static Doubles clamped(Doubles v, Doubles high) {
    const Doubles low{};
    return v < low ? low : (high < v ? high : v);
  }

  /// Barycentric coordinates of the nearest points: as nearest_on_triangle(), the first region that holds.
  ARRIS_INLINE static void nearest(const Face& face, const Vectors& q, const Eigen::Vector3d& ab,
                                   const Eigen::Vector3d& ac, Doubles& b, Doubles& c) {
    const Doubles zero{}, one = zero + 1.0;
    const Vectors ap = less(q, face.corners_mm[0]), bp = less(q, face.corners_mm[1]),
                  cp = less(q, face.corners_mm[2]);
    const Doubles d1 = dot(ap, ab), d2 = dot(ap, ac), d3 = dot(bp, ab), d4 = dot(bp, ac), d5 = dot(cp, ab),
                  d6 = dot(cp, ac);
    const Doubles vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const Doubles total = va + vb + vc;
    b = clamped(vb / total, one);
    c = clamped(vc / total, 1.0 - b);
    const Masks on_bc = (va <= zero) & (d4 >= d3) & (d5 >= d6);
    const Doubles w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    b = on_bc ? 1.0 - w : b;
    c = on_bc ? w : c;
    const Masks on_ac = (vb <= zero) & (d2 >= zero) & (d6 <= zero);
    b = on_ac ? zero : b;
    c = on_ac ? d2 / (d2 - d6) : c;
    const Masks on_ab = (vc <= zero) & (d1 >= zero) & (d3 <= zero);
    b = on_ab ? d1 / (d1 - d3) : b;
    c = on_ab ? zero : c;
    const Masks at_c = (d6 >= zero) & (d5 <= d6);
    b = at_c ? zero : b;
    c = at_c ? one : c;
    const Masks at_b = (d3 >= zero) & (d4 <= d3);
    b = at_b ? one : b;
    c = at_b ? zero : c;
    const Masks at_a = (d1 <= zero) & (d2 <= zero);
    b = at_a ? zero : b;
    c = at_a ? zero : c;
  }

  ARRIS_INLINE static void look_at(const Face& face, Feet& feet) {
    const Eigen::Vector3d& a = face.corners_mm[0];
    const Eigen::Vector3d ab = face.corners_mm[1] - a, ac = face.corners_mm[2] - a;
    const double number = face.number;
    for (int first = 0; first < kLanes; first += kWide) {
      const std::uint32_t lanes = (face.lanes >> static_cast<unsigned>(first)) & ((1U << kWide) - 1U);
      if (lanes == 0) continue;
      const Vectors q{at(feet.q_mm[0] + first), at(feet.q_mm[1] + first), at(feet.q_mm[2] + first)};
      Doubles b, c;
      nearest(face, q, ab, ac, b, c);
      const Vectors foot{(a.x() + b * ab.x()) + c * ac.x(), (a.y() + b * ab.y()) + c * ac.y(),
                         (a.z() + b * ab.z()) + c * ac.z()};
      const Vectors off{q.x - foot.x, q.y - foot.y, q.z - foot.z};
      const Doubles d2 = off.x * off.x + off.y * off.y + off.z * off.z;
      Doubles &limit2 = at(feet.limit2_mm2 + first), &triangle = at(feet.triangle + first);
      const Masks better = (d2 < limit2) | ((d2 == limit2) & ((triangle < 0.0) | (triangle > number)));
      const Doubles b_c = b < c ? b : c, in = 1.0 - b - c;
      const Doubles inside = (in < b_c ? in : b_c) - face.far_inside;
      take(limit2, better, d2);
      take(triangle, better, Doubles{} + number);
      take(at(feet.foot_mm[0] + first), better, foot.x);
      take(at(feet.foot_mm[1] + first), better, foot.y);
      take(at(feet.foot_mm[2] + first), better, foot.z);
      take(at(feet.b + first), better, b);
      take(at(feet.c + first), better, c);
      take(at(feet.height_mm + first), better, dot(off, face.normal));
      take(at(feet.inside + first), better, inside);
    }
  }

  ARRIS_INLINE static void take(Doubles& into, Masks better, Doubles value) { into = better ? value : into; }
};

void look_at_plain(const Face& face, Feet& feet) {
  Wide<2>::look_at(face, feet);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void look_at_avx2(const Face& face, Feet& feet) {
  Wide<4>::look_at(face, feet);
}
#endif

using Look = void (*)(const Face&, Feet&);

Look best_look() {
#if defined(__x86_64__)
  if (registers::has_avx2()) return look_at_avx2;
#endif
  return look_at_plain;
}

}  // namespace

void begin(Feet& feet, double limit2_mm2) {
  std::fill_n(feet.limit2_mm2, kLanes, limit2_mm2);
  std::fill_n(feet.triangle, kLanes, -1.0);
}

void put(std::int32_t triangle, const Eigen::Vector3d& foot_mm, const Eigen::Vector3d& barycentric,
         double distance2_mm2, int lane, Feet& feet) {
  for (int axis = 0; axis < 3; ++axis) feet.foot_mm[axis][lane] = foot_mm[axis];
  feet.triangle[lane] = triangle;
  feet.b[lane] = barycentric[1];
  feet.c[lane] = barycentric[2];
  feet.limit2_mm2[lane] = distance2_mm2;
  feet.inside[lane] = -1.0;
}

void look_at(const Face& face, Feet& feet) {
  static const Look look = best_look();
  look(face, feet);
}

}  // namespace arris::packet
