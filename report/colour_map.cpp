#include "report/colour_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "report/number_text.hpp"

namespace arris::report {
namespace {

constexpr int kStepsBeyond = 4;
constexpr std::array<Rgb, kStepsBeyond> kAbove = {
    {{255, 214, 102}, {244, 160, 48}, {214, 98, 28}, {150, 52, 16}}};
constexpr std::array<Rgb, kStepsBeyond> kBelow = {
    {{176, 214, 245}, {100, 168, 226}, {42, 112, 190}, {20, 62, 132}}};
constexpr Rgb kGreenAbove{128, 196, 118}, kGreenBelow{94, 178, 142};

constexpr std::uint32_t kInfinityBits = 0x7F800000U;

/// Of a size: floats that are not negative are in the order of their bits.
std::uint32_t size_bits(float value) {
  return std::bit_cast<std::uint32_t>(value) & 0x7FFFFFFFU;
}

/// Takes the full bins before a place off it; returns the bin that holds it.
std::uint32_t bin_of(const std::vector<std::size_t>& bins, std::size_t& place) {
  std::uint32_t bin = 0;
  while (place >= bins[bin]) place -= bins[bin++];
  return bin;
}

/// The size at this part of all finite ones in their order; none where there are none. Counted by the upper
/// half of the bits, then by the lower: without a copy of a big scan's values.
std::optional<float> size_at(std::span<const float> values, double ratio) {
  constexpr std::uint32_t kHalf = 16, kLow = 0xFFFFU;
  std::vector<std::size_t> upper(kInfinityBits >> kHalf), lower(kLow + 1);
  std::size_t count = 0;
  for (const float value : values) {
    const std::uint32_t bits = size_bits(value);
    if (bits >= kInfinityBits) continue;
    ++upper[bits >> kHalf];
    ++count;
  }
  if (count == 0) return std::nullopt;
  auto place = static_cast<std::size_t>(ratio * static_cast<double>(count - 1));
  const std::uint32_t bin = bin_of(upper, place);
  for (const float value : values)
    if (size_bits(value) >> kHalf == bin) ++lower[size_bits(value) & kLow];
  return std::bit_cast<float>((bin << kHalf) | bin_of(lower, place));
}

}  // namespace

std::string to_hex(const Rgb& colour) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
    text += kDigits[part >> 4U];
    text += kDigits[part & 15U];
  }
  return text;
}

ColourMap::ColourMap(double tolerance_mm, double limit_mm)
    : half_zone_mm_(std::max(0.0, 0.5 * tolerance_mm)) {
  const double limit = limit_mm > half_zone_mm_ ? limit_mm : half_zone_mm_ + 1.0;
  const auto edge = [&](int k) { return half_zone_mm_ + (limit - half_zone_mm_) * k / kStepsBeyond; };
  for (int k = kStepsBeyond; k > 0; --k)
    steps_.push_back({-edge(k), -edge(k - 1), kBelow[static_cast<std::size_t>(k - 1)]});
  if (half_zone_mm_ > 0.0) {
    steps_.push_back({-half_zone_mm_, 0.0, kGreenBelow});
    steps_.push_back({0.0, half_zone_mm_, kGreenAbove});
  }
  for (int k = 0; k < kStepsBeyond; ++k)
    steps_.push_back({edge(k), edge(k + 1), kAbove[static_cast<std::size_t>(k)]});
}

int ColourMap::step_of(double deviation_mm) const {
  const int count = static_cast<int>(steps_.size());
  const auto step = [&](int i) -> const ColourStep& { return steps_[static_cast<std::size_t>(i)]; };
  if (deviation_mm >= 0.0) {
    int i = count / 2;
    while (i < count && deviation_mm > step(i).to_mm) ++i;
    return i;
  }
  int i = count / 2 - 1;
  while (i >= 0 && deviation_mm < step(i).from_mm) --i;
  return i;
}

Rgb ColourMap::colour(double deviation_mm) const {
  if (!std::isfinite(deviation_mm)) return no_data();
  const int i = step_of(deviation_mm);
  if (i < 0) return under_scale();
  return i < static_cast<int>(steps_.size()) ? steps_[static_cast<std::size_t>(i)].colour : over_scale();
}

Rgb ColourMap::over_scale() {
  return {214, 22, 140};
}
Rgb ColourMap::under_scale() {
  return {26, 8, 48};
}
Rgb ColourMap::no_data() {
  return {217, 217, 217};
}

ColourMap colour_map_for(std::span<const float> deviation_mm, double tolerance_mm) {
  const double half = std::max(0.0, 0.5 * tolerance_mm);
  const double target = std::max(3.0 * half, static_cast<double>(size_at(deviation_mm, 0.99).value_or(0.0F)));
  const double step = nice_at_least((target - half) / kStepsBeyond);
  return ColourMap(tolerance_mm, half + kStepsBeyond * step);
}

}  // namespace arris::report
