#include "acquisition/files/number.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

namespace arris::files {
namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Law: the same double as std::from_chars, to the last bit, and the same end.
TEST(ParseNumber, RoundsAsFromChars) {
  std::mt19937_64 random(11);
  for (int i = 0; i < 300000; ++i) {
    char text[64];
    const double value =
        std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 140) - 110);
    const char* const formats[] = {"%.3f", "%.6f", "%.9f", "%.15g", "%.17g", "%e", "%.12e", "%g"};
    std::snprintf(text, sizeof text, formats[random() % 8], random() % 2 == 0 ? value : -value);
    const char* const end = text + std::strlen(text);
    double expected = 0.0;
    ASSERT_EQ(std::from_chars(text, end, expected).ptr, end) << text;
    double parsed = 0.0;
    ASSERT_EQ(parse_number(text, end, false, parsed), end) << text;
    ASSERT_TRUE(same_bits(parsed, expected)) << text;
    for (char& c : text)
      if (c == '.') c = ',';
    ASSERT_EQ(parse_number(text, end, true, parsed), end) << text;
    ASSERT_TRUE(same_bits(parsed, expected)) << text;
  }
}

TEST(ParseNumber, Spellings) {
  const std::pair<const char*, double> table[] = {
      {"+1", 1},
      {"-0", -0.0},
      {".5", 0.5},
      {"5.", 5},
      {"1e3", 1000},
      {"1E+003", 1000},
      {"1e-400", 0},
      {"1e400", INFINITY},
      {"-1e400", -INFINITY},
      {"0.0000000000000000000000001", 1e-25},
      {"123456789012345678901234567890", 123456789012345678901234567890.0},
      {"inf", INFINITY},
      {"-inf", -INFINITY}};
  for (const auto& [text, value] : table) {
    double parsed = 77;
    EXPECT_EQ(parse_number(text, text + std::strlen(text), false, parsed), text + std::strlen(text)) << text;
    EXPECT_TRUE(same_bits(parsed, value)) << text << " " << parsed;
  }
  for (const char* text : {"nan", "NaN", "-nan", "nan(ind)", "1.#QNAN", "-1.#IND", "1.#IND00", "1.#INF"}) {
    double parsed = 77;
    EXPECT_EQ(parse_number(text, text + std::strlen(text), false, parsed), text + std::strlen(text)) << text;
    EXPECT_TRUE(std::isnan(parsed)) << text;
  }
  for (const char* text : {"", "-", "+", ".", "x", "e5", "+-1", "--1", "#", "\n"}) {
    double parsed = 77;
    EXPECT_EQ(parse_number(text, text + std::strlen(text), false, parsed), text) << text;
  }
  double parsed = 0;
  const std::string tail = "1.5e x";
  EXPECT_EQ(parse_number(tail.data(), tail.data() + tail.size(), false, parsed), tail.data() + 3);
  EXPECT_EQ(parsed, 1.5);
}

}  // namespace
}  // namespace arris::files
