#include "acquisition/files/weld.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace arris::files {
namespace {

constexpr std::size_t kAhead = 32;  // slots fetched before they are needed

std::uint32_t hash_of(const Eigen::Vector3f& p) {
  const auto x = std::bit_cast<std::uint32_t>(p.x());
  const auto y = std::bit_cast<std::uint32_t>(p.y());
  const auto z = std::bit_cast<std::uint32_t>(p.z());
  std::uint64_t h = ((std::uint64_t{x} << 32) | y) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ (h >> 29) ^ z) * 0xBF58476D1CE4E5B9ULL;
  return static_cast<std::uint32_t>(h >> 32);
}

std::uint32_t hash_of(const Eigen::Vector3d& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) {
    h = (h ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9E3779B97F4A7C15ULL;
    h ^= h >> 29;
  }
  return static_cast<std::uint32_t>((h * 0xBF58476D1CE4E5B9ULL) >> 32);
}

template <class Point>
bool same_bits(const Point& a, const Point& b) {
  // The bits and not the values: -0 is not 0, and a NaN is itself.
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return std::memcmp(a.data(), b.data(), sizeof(Point)) == 0;
}

}  // namespace

template <class Real>
Welder<Real>::Welder(std::size_t corners_expected) {
  // A closed mesh has a sixth as many points as corners; the table is to be at most half full.
  slots_.resize(std::bit_ceil(std::max<std::size_t>(64, corners_expected / 3)));
  points_.reserve(corners_expected / 6 + 8);
}

template <class Real>
void Welder<Real>::add(std::span<const Point> corners, std::int32_t* index) {
  std::array<Point, kAhead> points;
  std::array<std::uint32_t, kAhead> hashes;
  for (std::size_t at = 0; at < corners.size(); at += kAhead) {
    const std::size_t count = std::min(kAhead, corners.size() - at);
    for (std::size_t i = 0; i < count; ++i) {
      points[i] = corners[at + i].array() + Real{0};  // -0 + 0 = 0
      hashes[i] = hash_of(points[i]);
      __builtin_prefetch(&slots_[hashes[i] & (slots_.size() - 1)]);
    }
    for (std::size_t i = 0; i < count; ++i) index[at + i] = find_or_add(points[i], hashes[i]);
  }
}

template <class Real>
std::int32_t Welder<Real>::find_or_add(const Point& point, std::uint32_t hash) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash & mask;
  while (slots_[at].index >= 0) {
    const Slot& slot = slots_[at];
    if (slot.hash == hash && same_bits(points_[static_cast<std::size_t>(slot.index)], point))
      return slot.index;
    at = (at + 1) & mask;
  }
  const auto index = static_cast<std::int32_t>(points_.size());
  slots_[at] = {hash, index};
  points_.push_back(point);
  if (2 * points_.size() > slots_.size()) grow();
  return index;
}

template <class Real>
void Welder<Real>::grow() {
  std::vector<Slot> larger(2 * slots_.size());
  const std::size_t mask = larger.size() - 1;
  for (const Slot& slot : slots_) {
    if (slot.index < 0) continue;
    std::size_t at = slot.hash & mask;
    while (larger[at].index >= 0) at = (at + 1) & mask;
    larger[at] = slot;
  }
  slots_.swap(larger);
}

template class Welder<float>;
template class Welder<double>;

}  // namespace arris::files
