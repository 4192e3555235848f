#include "report/colour_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/number_text.hpp"

namespace arris::report {
namespace {

constexpr int kStepsBeyond = 4;
constexpr std::array<Rgb, kStepsBeyond> kAbove = {
    {{255, 214, 102}, {244, 160, 48}, {214, 98, 28}, {150, 52, 16}}};
constexpr std::array<Rgb, kStepsBeyond> kBelow = {
    {{176, 214, 245}, {100, 168, 226}, {42, 112, 190}, {20, 62, 132}}};
constexpr Rgb kGreenAbove{128, 196, 118}, kGreenBelow{94, 178, 142};

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
  std::vector<float> size;  // of a big scan: no more memory than the deviations themselves
  size.reserve(deviation_mm.size());
  for (const float d : deviation_mm)
    if (std::isfinite(d)) size.push_back(std::abs(d));
  const double half = std::max(0.0, 0.5 * tolerance_mm);
  double target = 3.0 * half;
  if (!size.empty()) {
    const auto at = size.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(size.size() - 1));
    std::nth_element(size.begin(), at, size.end());
    target = std::max(target, static_cast<double>(*at));
  }
  const double step = nice_at_least((target - half) / kStepsBeyond);
  return ColourMap(tolerance_mm, half + kStepsBeyond * step);
}

}  // namespace arris::report
