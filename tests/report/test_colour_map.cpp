#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "report/colour_map.hpp"

namespace arris::report {
namespace {

bool is_green(const Rgb& c) {
  return c.green > c.red && c.green > c.blue;
}

TEST(ColourMap, GreenIsExactlyTheZone) {
  for (const double tolerance : {0.05, 0.3, 1.0, 7.0}) {
    const ColourMap map(tolerance, 4.0 * tolerance);
    const double half = 0.5 * tolerance, tiny = 1e-9;
    for (const double inside : {0.0, half, -half, 0.5 * half, -0.5 * half, half - tiny})
      EXPECT_TRUE(is_green(map.colour(inside))) << tolerance << " " << inside;
    for (const double outside : {half + tiny, -half - tiny, 2.0 * half, -map.limit_mm(), map.limit_mm()})
      EXPECT_FALSE(is_green(map.colour(outside))) << tolerance << " " << outside;
  }
}

TEST(ColourMap, SymmetricWithoutGaps) {
  const ColourMap map(1.0, 4.5);
  const auto& steps = map.steps();
  ASSERT_EQ(steps.size(), 10U);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_DOUBLE_EQ(steps[i].from_mm, -steps[steps.size() - 1 - i].to_mm);
    if (i == 0) continue;
    EXPECT_DOUBLE_EQ(steps[i].from_mm, steps[i - 1].to_mm);
  }
  std::set<std::string> colours;
  for (const ColourStep& step : steps) {
    colours.insert(to_hex(step.colour));
    EXPECT_EQ(map.colour(0.5 * (step.from_mm + step.to_mm)), step.colour);
  }
  EXPECT_EQ(colours.size(), steps.size());
}

TEST(ColourMap, BeyondTheScaleAndNoDataHaveTheirOwn) {
  const ColourMap map(1.0, 4.5);
  EXPECT_EQ(map.colour(4.6), ColourMap::over_scale());
  EXPECT_EQ(map.colour(-4.6), ColourMap::under_scale());
  EXPECT_EQ(map.colour(std::numeric_limits<double>::quiet_NaN()), ColourMap::no_data());
  EXPECT_EQ(map.colour(std::numeric_limits<double>::infinity()), ColourMap::no_data());
  for (const ColourStep& step : map.steps())
    for (const Rgb& special : {ColourMap::over_scale(), ColourMap::under_scale(), ColourMap::no_data()})
      EXPECT_NE(step.colour, special);
}

TEST(ColourMap, LightnessTellsTheStepsApart) {
  // For eyes that mix up hues: outwards from the zone each side gets strictly darker.
  const auto lightness = [](const Rgb& c) { return 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue; };
  const ColourMap map(1.0, 4.5);
  const auto& steps = map.steps();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(lightness(steps[i].colour), lightness(steps[i + 1].colour));
    EXPECT_GT(lightness(steps[6 + i].colour), lightness(steps[7 + i].colour));
  }
}

TEST(ColourMap, WithoutToleranceThereIsNoGreen) {
  const ColourMap map(0.0, 2.0);
  for (const ColourStep& step : map.steps()) EXPECT_FALSE(is_green(step.colour));
  EXPECT_EQ(map.steps().size(), 8U);
}

TEST(ColourMap, ScaleIsChosenRoundAndWideEnough) {
  std::vector<float> deviation;
  for (int i = -1000; i <= 1000; ++i) deviation.push_back(0.011F * static_cast<float>(i));
  deviation.push_back(500.0F);  // one stray point does not stretch the scale
  const ColourMap map = colour_map_for(deviation, 1.0);
  EXPECT_DOUBLE_EQ(map.half_zone_mm(), 0.5);
  EXPECT_DOUBLE_EQ(map.limit_mm(), 12.5);  // 0.5 + 4 x 3
  EXPECT_DOUBLE_EQ(colour_map_for({}, 1.0).limit_mm(), 1.5);
  EXPECT_GT(colour_map_for({}, 0.0).limit_mm(), 0.0);
}

}  // namespace
}  // namespace arris::report
