#include "acquisition/geometry/curve_order.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/geometry/registers.hpp"

namespace arris {
namespace {

constexpr int kBits = 10;  // an axis
constexpr std::uint32_t kCells = 1U << kBits;
constexpr std::size_t kChunk = 16384;
constexpr int kDigitBits = 10, kDigits = 3;  // of the radix sort: 30 bits
constexpr std::uint32_t kDigitValues = 1U << kDigitBits;
constexpr std::size_t kMany = 65536;  // of so many the top digit parts them for the threads

struct Keyed {
  std::uint32_t key, point;
};

// Vectors of GCC and Clang: the keys of eight points take as long as that of one.
constexpr std::size_t kLanes = 8;
using Lanes = std::uint32_t __attribute__((vector_size(4 * kLanes)));

/// Places of cells on the curve (Skilling 2004: axes to transpose, then its bits interleaved). Without
/// branches: the bits of scattered points are not foreseen.
ARRIS_INLINE void places_on_curve(std::array<Lanes, 3>& x, Lanes& key) {
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

/// A box that grows by addition.
struct Boxed {
  Eigen::AlignedBox3f box;
  Boxed& operator+=(const Boxed& other) {
    box.extend(other.box);
    return *this;
  }
};

struct Grid {
  Eigen::Vector3f low_mm;
  float cells_per_mm;
};

ARRIS_INLINE void keys_of(std::span<const Eigen::Vector3f> points_mm, const Grid& grid, std::size_t begin,
                          std::span<Keyed> items) {
  for (std::size_t first = 0; first < items.size(); first += kLanes) {
    std::array<Lanes, 3> cell{};
    const std::size_t count = std::min(kLanes, items.size() - first);
    std::array<bool, kLanes> is_point{};
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Vector3f& p_mm = points_mm[begin + first + k];
      is_point[k] = p_mm.allFinite();
      if (!is_point[k]) continue;
      const Eigen::Vector3f at = (p_mm - grid.low_mm) * grid.cells_per_mm;
      for (std::size_t axis = 0; axis < 3; ++axis)
        cell[axis][k] = std::min(kCells - 1, static_cast<std::uint32_t>(at[static_cast<int>(axis)]));
    }
    Lanes key;
    places_on_curve(cell, key);
    for (std::size_t k = 0; k < count; ++k)
      items[first + k] = {is_point[k] ? key[k] : 0U, static_cast<std::uint32_t>(begin + first + k)};
  }
}

using KeysOf = void (*)(std::span<const Eigen::Vector3f>, const Grid&, std::size_t, std::span<Keyed>);

void keys_plain(std::span<const Eigen::Vector3f> points_mm, const Grid& grid, std::size_t begin,
                std::span<Keyed> items) {
  keys_of(points_mm, grid, begin, items);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void keys_avx2(std::span<const Eigen::Vector3f> points_mm, const Grid& grid,
                                       std::size_t begin, std::span<Keyed> items) {
  keys_of(points_mm, grid, begin, items);
}
#else
constexpr KeysOf keys_avx2 = keys_plain;
#endif

std::vector<Keyed> keyed(std::span<const Eigen::Vector3f> points_mm, int threads) {
  const Eigen::AlignedBox3f box =
      parallel_sum(points_mm.size(), kChunk, threads, Boxed(), [&](std::size_t begin, std::size_t end) {
        return Boxed{box_of(points_mm.subspan(begin, end - begin))};
      }).box;
  const float size = box.isEmpty() ? 0.0F : box.sizes().maxCoeff();
  const Grid grid{box.min(), size > 0.0F ? static_cast<float>(kCells) / size : 0.0F};
  const KeysOf fill = registers::has_avx2() ? keys_avx2 : keys_plain;
  std::vector<Keyed> items(points_mm.size());
  parallel_for(points_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    fill(points_mm, grid, begin, std::span(items).subspan(begin, end - begin));
  });
  return items;
}

std::uint32_t digit_of(const Keyed& item, int digit) {
  return (item.key >> (digit * kDigitBits)) & (kDigitValues - 1U);
}

/// By the lower digits, the order kept among equals. The answer is in `items` after an even number of digits.
void sort_by_digits(std::span<Keyed> items, std::span<Keyed> next, int digits) {
  for (int digit = 0; digit < digits; ++digit) {
    std::array<std::uint32_t, kDigitValues + 1> first{};
    for (const Keyed& item : items) ++first[digit_of(item, digit) + 1];
    for (std::size_t d = 1; d < first.size(); ++d) first[d] += first[d - 1];
    for (const Keyed& item : items) next[first[digit_of(item, digit)]++] = item;
    std::swap(items, next);
  }
}

/// Parted by the top digit first, then each part by itself: it fits the cache, and threads share them.
void sort_many(std::vector<Keyed>& items, std::vector<Keyed>& next, int threads) {
  constexpr int kTop = kDigits - 1;
  using Counts = std::array<std::uint32_t, kDigitValues>;
  std::vector<Counts> places((items.size() - 1) / kChunk + 1);
  parallel_for(items.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    Counts& counts = places[begin / kChunk];
    counts.fill(0);
    for (std::size_t i = begin; i < end; ++i) ++counts[digit_of(items[i], kTop)];
  });
  std::vector<std::uint32_t> first(kDigitValues + 1, 0);
  std::uint32_t passed = 0;
  for (std::uint32_t d = 0; d < kDigitValues; ++d) {
    first[d] = passed;
    for (Counts& counts : places) passed += std::exchange(counts[d], passed);
  }
  first[kDigitValues] = passed;
  parallel_for(items.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    Counts& place = places[begin / kChunk];
    for (std::size_t i = begin; i < end; ++i) next[place[digit_of(items[i], kTop)]++] = items[i];
  });
  parallel_for(kDigitValues, 8, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t d = begin; d < end; ++d) {
      const std::size_t count = first[d + 1] - first[d];
      if (count > 1)
        sort_by_digits(std::span(next).subspan(first[d], count), std::span(items).subspan(first[d], count),
                       kTop);
    }
  });
  std::swap(items, next);
}

}  // namespace

std::vector<std::uint32_t> curve_order(std::span<const Eigen::Vector3f> points_mm, int threads) {
  std::vector<Keyed> items = keyed(points_mm, threads), next(items.size());
  if (items.size() < kMany) {
    sort_by_digits(items, next, kDigits);
    std::swap(items, next);
  } else {
    sort_many(items, next, threads);
  }
  std::vector<std::uint32_t> order(items.size());
  parallel_for(items.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) order[i] = items[i].point;
  });
  return order;
}

}  // namespace arris
