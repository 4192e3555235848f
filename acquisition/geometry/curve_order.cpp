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

/// Place of a cell on the curve (Skilling 2004: axes to transpose, then its bits interleaved).
std::uint32_t place_on_curve(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = kCells >> 1U; q > 1; q >>= 1U) {
    const std::uint32_t below = q - 1;
    for (std::uint32_t& axis : x) {  // without branches: the bits of scattered points are not foreseen
      const std::uint32_t set = 0U - static_cast<std::uint32_t>((axis & q) != 0);
      const std::uint32_t swapped = (x[0] ^ axis) & below & ~set;
      x[0] ^= (below & set) | swapped;
      axis ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t turned = 0;
  for (std::uint32_t q = kCells >> 1U; q > 1; q >>= 1U)
    turned ^= (q - 1) & (0U - static_cast<std::uint32_t>((x[2] & q) != 0));
  std::uint32_t key = 0;
  for (int bit = kBits - 1; bit >= 0; --bit)
    for (const std::uint32_t axis : x) key = (key << 1U) | (((axis ^ turned) >> bit) & 1U);
  return key;
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
    for (std::size_t i = begin; i < end; ++i) {
      items[i] = {0, static_cast<std::uint32_t>(i)};
      if (!points_mm[i].allFinite()) continue;
      const Eigen::Vector3f at = (points_mm[i] - box.min()) * cells_per_mm;
      std::array<std::uint32_t, 3> cell;
      for (std::size_t axis = 0; axis < 3; ++axis)
        cell[axis] = std::min(kCells - 1, static_cast<std::uint32_t>(at[static_cast<int>(axis)]));
      items[i].key = place_on_curve(cell);
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
