#include "report/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace arris::report {

std::string fixed_text(double value, int digits) {
  if (!std::isfinite(value)) return "nan";
  std::array<char, 400> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, digits);
  std::string text(buffer.data(), end.ptr);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  if (is_zero && text.front() == '-') text.erase(0, 1);
  return text;
}

std::string people_text(double value, int digits) {
  return std::isfinite(value) ? fixed_text(value, digits) : "no data";
}

std::string minus_text(double value, int digits) {
  std::string text = people_text(value, digits);
  return text.front() == '-' ? text.replace(0, 1, "\u2212") : text;
}

std::string signed_text(double value, int digits) {
  std::string text = minus_text(value, digits);
  const bool is_plain = text.find_first_of("123456789") == std::string::npos || value < 0.0;
  return is_plain ? text : text.insert(0, 1, '+');
}

double rounded(double value) {
  if (!std::isfinite(value) || std::abs(value) > 1e9) return value;
  const double result = std::round(value * 1e6) / 1e6;
  return result == 0.0 ? 0.0 : result;
}

std::string grouped_text(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ' ');
  return text;
}

double nice_at_least(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return 1.0;
  constexpr std::array<double, 10> kSteps = {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : kSteps)
    if (step * power >= value * (1.0 - 1e-9)) return step * power;
  return 10.0 * power;
}

int digits_for_step(double step) {
  double scaled = std::abs(step);
  for (int digits = 0; digits < 4; ++digits, scaled *= 10.0)
    if (std::abs(scaled - std::round(scaled)) < 1e-6 * std::max(1.0, scaled)) return digits;
  return 4;
}

}  // namespace arris::report
