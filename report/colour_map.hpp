#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace arris::report {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};
[[nodiscard]] std::string to_hex(const Rgb& colour);  ///< "#1b9e77"

/// One step of the scale: colour of from_mm .. to_mm.
struct ColourStep {
  double from_mm = 0.0, to_mm = 0.0;
  Rgb colour;
};

/// Signed deviation -> colour, in steps that are symmetric about zero. Green is exactly the tolerance zone
/// (|d| <= tolerance / 2, two shades for the two signs); blues below it, yellow to brown above it, told apart
/// by lightness as well as hue, so that it reads with any colour vision; beyond the scale and no data have
/// their own.
class ColourMap {
 public:
  /// tolerance_mm: full width of the zone; 0: none, and no green. limit_mm: end of the scale, over
  /// tolerance_mm / 2.
  ColourMap(double tolerance_mm, double limit_mm);

  [[nodiscard]] Rgb colour(double deviation_mm) const;  ///< NaN: no_data()
  /// Index into steps(); -1 under scale, steps().size() over scale. A value on an edge belongs to the step
  /// nearer to zero, so that the zone is closed. Not for NaN.
  [[nodiscard]] int step_of(double deviation_mm) const;
  [[nodiscard]] const std::vector<ColourStep>& steps() const { return steps_; }  ///< ascending, without gaps
  [[nodiscard]] double limit_mm() const { return steps_.back().to_mm; }
  [[nodiscard]] double half_zone_mm() const { return half_zone_mm_; }
  [[nodiscard]] static Rgb over_scale();
  [[nodiscard]] static Rgb under_scale();
  [[nodiscard]] static Rgb no_data();

 private:
  double half_zone_mm_ = 0.0;
  std::vector<ColourStep> steps_;
};

/// The one scale of a run, used by every picture and file: the zone, then four equal steps of a round number
/// on each side, the last at or beyond 99 % of the |deviations| (and at least three half zones).
[[nodiscard]] ColourMap colour_map_for(std::span<const float> deviation_mm, double tolerance_mm);

}  // namespace arris::report
