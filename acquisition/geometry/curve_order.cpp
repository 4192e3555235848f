#include "acquisition/geometry/curve_order.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "acquisition/geometry/parallel_for.hpp"

namespace arris {
namespace {

constexpr int kBits = 10;  // an axis
constexpr std::uint32_t kCells = 1U << kBits;
constexpr std::size_t kChunk = 16384;
constexpr int kDigitBits = 10, kDigits = 3;  // of the radix sort: 30 bits

struct Keyed {
  std::uint32_t key, point;
};

// Vectors of GCC and Clang: the keys of eight points take as long as that of one.
constexpr std::size_t kLanes = 8;
using Lanes = std::uint32_t __attribute__((vector_size(4 * kLanes)));

/// Places of cells on the curve (Skilling 2004: axes to transpose, then its bits interleaved). Without
/// branches: the bits of scattered points are not foreseen.
void places_on_curve(std::array<Lanes, 3>& x, Lanes& key) {
  for (unsigned shift = kBits - 1; shift > 0; --shift) {
    const std::uint32_t below = (1U << shift) - 1U;
    for (Lanes& axis : x) {
      const Lanes set = 0U - ((axis >> shift) & 1U);
      const Lanes swapped = (x[0] ^ axis) & below & ~set;
      x[0] ^= (below & set) | swapped;
      axis ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  Lanes turned{};
  for (unsigned shift = kBits - 1; shift > 0; --shift)
    turned ^= ((1U << shift) - 1U) & (0U - ((x[2] >> shift) & 1U));
  key = Lanes{};
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (const Lanes& axis : x) key = (key << 1U) | (((axis ^ turned) >> static_cast<unsigned>(bit)) & 1U);
}

Eigen::AlignedBox3f box_of(std::span<const Eigen::Vector3f> points_mm) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points_mm)
    if (p.allFinite()) box.extend(p);
  return box;
}

std::vector<Keyed> keyed(std::span<const Eigen::Vector3f> points_mm, int threads) {
  const Eigen::AlignedBox3f box = box_of(points_mm);
  const float size = box.isEmpty() ? 0.0F : box.sizes().maxCoeff();
  const float cells_per_mm = size > 0.0F ? static_cast<float>(kCells) / size : 0.0F;
  std::vector<Keyed> items(points_mm.size());
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin; first < end; first += kLanes) {
      std::array<Lanes, 3> cell{};
      const std::size_t count = std::min(kLanes, end - first);
      for (std::size_t k = 0; k < count; ++k) {
        if (!points_mm[first + k].allFinite()) continue;
        const Eigen::Vector3f at = (points_mm[first + k] - box.min()) * cells_per_mm;
        for (std::size_t axis = 0; axis < 3; ++axis)
          cell[axis][k] = std::min(kCells - 1, static_cast<std::uint32_t>(at[static_cast<int>(axis)]));
      }
      Lanes key;
      places_on_curve(cell, key);
      for (std::size_t k = 0; k < count; ++k) {
        const bool is_point = points_mm[first + k].allFinite();
        items[first + k] = {is_point ? key[k] : 0U, static_cast<std::uint32_t>(first + k)};
      }
    }
  });
  return items;
}

}  // namespace

std::vector<std::uint32_t> curve_order(std::span<const Eigen::Vector3f> points_mm, int threads) {
  std::vector<Keyed> items = keyed(points_mm, threads), next(items.size());
  for (int digit = 0; digit < kDigits; ++digit) {
    const int shift = digit * kDigitBits;
    const auto digit_of = [shift](const Keyed& item) {
      return (item.key >> shift) & ((1U << kDigitBits) - 1U);
    };
    std::array<std::uint32_t, (1U << kDigitBits) + 1> first{};
    for (const Keyed& item : items) ++first[digit_of(item) + 1];
    for (std::size_t d = 1; d < first.size(); ++d) first[d] += first[d - 1];
    for (const Keyed& item : items) next[first[digit_of(item)]++] = item;
    std::swap(items, next);
  }
  std::vector<std::uint32_t> order(items.size());
  std::transform(items.begin(), items.end(), order.begin(), [](const Keyed& item) { return item.point; });
  return order;
}

}  // namespace arris
