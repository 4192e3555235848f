#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace arris::files {

/// The long way of parse_number: more than 19 digits, large exponents, nan, inf, 1.#QNAN.
[[nodiscard]] const char* parse_number_slowly(const char* p, const char* end, bool comma, double& value);

/// Up to eight digits at p, of which eight bytes can be read: their number, and how many they are. What is
/// not a digit is found with one mask, and three multiplications turn eight digits into a number (pairs, then
/// fours, then all).
struct Digits {
  std::uint64_t number = 0;
  int count = 0;
};

[[nodiscard]] inline Digits digits_at(const char* p) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, p, sizeof bytes);
  bytes ^= 0x3030303030303030ULL;
  const std::uint64_t other = ((bytes + 0x0606060606060606ULL) | bytes) & 0xF0F0F0F0F0F0F0F0ULL;
  const int count = other == 0 ? 8 : std::countr_zero(other) / 8;
  if (count == 0) return {};
  bytes <<= 64 - 8 * count;
  bytes = (bytes * 10 + (bytes >> 8)) & 0x00FF00FF00FF00FFULL;
  bytes = (bytes * 100 + (bytes >> 16)) & 0x0000FFFF0000FFFFULL;
  return {(bytes * 10000 + (bytes >> 32)) & 0xFFFFFFFFULL, count};
}

/// Bytes that parse_plain_number may look at.
constexpr std::ptrdiff_t kPlainNumberBytes = 32;

/// The same as parse_number for the usual number, at most seven digits on each side of a point and no
/// exponent, of which kPlainNumberBytes bytes can be read. Null for any other, and for one that anything but
/// blank, comma, semicolon, tab or a line end follows.
[[nodiscard]] inline const char* parse_plain_number(const char* p, double& value) {
  static constexpr std::uint64_t kWholePowers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000};
  static constexpr double kPowers[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
  static constexpr std::uint64_t kEnds =
      1ULL << '\t' | 1ULL << '\n' | 1ULL << '\r' | 1ULL << ' ' | 1ULL << ',' | 1ULL << ';';
  const bool negative = *p == '-';
  p += negative;
  const Digits whole = digits_at(p);
  p += whole.count;
  std::uint64_t mantissa = whole.number;
  int power = 0;
  if (*p == '.') {
    const Digits fraction = digits_at(++p);
    power = fraction.count;
    if (power == 8) return nullptr;
    p += power;
    mantissa = mantissa * kWholePowers[power] + fraction.number;
  }
  const auto after = static_cast<unsigned char>(*p);
  const bool ends = after < 64 && ((kEnds >> after) & 1) != 0;
  if (whole.count == 8 || whole.count + power == 0 || !ends) return nullptr;
  const double size = static_cast<double>(mantissa) / kPowers[power];
  value = negative ? -size : size;
  return p;
}

/// Reads one number at p; returns the place after it, or p when there is none.
///   comma    a decimal comma is taken as well as a point
///   value    as std::from_chars rounds it: an integer mantissa up to 2^53 times or over a power of ten up to
///   1e22 is
///            exact before the one rounding (Clinger, "How to read floating point numbers accurately", 1990);
///            every other number goes to std::from_chars. Too large gives infinity, too small zero.
[[nodiscard]] inline const char* parse_number(const char* p, const char* end, bool comma, double& value) {
  static constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                       1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char* const start = p;
  const auto digit = [](char c) { return static_cast<unsigned>(c) - '0'; };
  bool negative = false;
  if (p < end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  const char* const first = p;
  std::uint64_t mantissa = 0;
  for (; p < end && digit(*p) < 10; ++p) mantissa = mantissa * 10 + digit(*p);
  auto digits = p - first;
  int power = 0;
  if (p < end && (*p == '.' || (comma && *p == ','))) {
    const char* const fraction = ++p;
    for (; p < end && digit(*p) < 10; ++p) mantissa = mantissa * 10 + digit(*p);
    power = fraction - p < -1000 ? -1000 : static_cast<int>(fraction - p);
    digits += p - fraction;
  }
  if (digits == 0 || digits > 19 || mantissa > (1ULL << 53))
    return parse_number_slowly(start, end, comma, value);
  if (p < end && (*p == 'e' || *p == 'E')) {
    const char* e = p + 1;
    const bool minus = e < end && *e == '-';
    if (e < end && (*e == '-' || *e == '+')) ++e;
    int exponent = 0;
    const char* const exponent_digits = e;
    for (; e < end && digit(*e) < 10 && e - exponent_digits < 4; ++e)
      exponent = exponent * 10 + static_cast<int>(digit(*e));
    if (e == exponent_digits || (e < end && digit(*e) < 10))
      return parse_number_slowly(start, end, comma, value);
    power += minus ? -exponent : exponent;
    p = e;
  } else if (p < end && *p == '#') {
    return parse_number_slowly(start, end, comma, value);
  }
  if (power < -22 || power > 22) return parse_number_slowly(start, end, comma, value);
  const double whole = static_cast<double>(mantissa);
  const double size = power < 0 ? whole / kPowers[-power] : whole * kPowers[power];
  value = negative ? -size : size;
  return p;
}

}  // namespace arris::files
