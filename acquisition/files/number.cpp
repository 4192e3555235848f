#include "acquisition/files/number.hpp"

#include <charconv>
#include <limits>
#include <string>
#include <string_view>

namespace arris::files {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What std::from_chars calls out of range: too small when its exponent or its leading zero says so.
double out_of_range(std::string_view token) {
  const bool negative = token.front() == '-';
  if (negative) token.remove_prefix(1);
  const std::size_t e = token.find_first_of("eE");
  const bool tiny = e != std::string_view::npos ? token.substr(e + 1, 1) == "-" : token.front() == '0';
  const double size = tiny ? 0.0 : kInfinity;
  return negative ? -size : size;
}

/// Microsoft's spellings: 1.#QNAN, -1.#IND, 1.#INF.
const char* after_microsoft_nan(const char* p, const char* end) {
  static constexpr std::string_view kNames[] = {"#QNAN", "#SNAN", "#IND", "#INF"};
  const std::string_view rest(p, static_cast<std::size_t>(end - p));
  for (const std::string_view name : kNames) {
    if (rest.substr(0, name.size()) != name) continue;
    p += name.size();
    while (p < end && *p >= '0' && *p <= '9') ++p;
    return p;
  }
  return nullptr;
}

}  // namespace

const char* parse_number_slowly(const char* p, const char* end, bool comma, double& value) {
  const char* start = p < end && *p == '+' ? p + 1 : p;
  if (start != p && start < end && *start == '-') return p;
  std::string point;  // the token with its decimal comma made a point
  const char* from = start;
  const char* to = end;
  if (comma) {
    const std::string_view rest(start, static_cast<std::size_t>(end - start));
    point = rest.substr(0, rest.find_first_not_of("0123456789+-.,eEnaifNAIFtyTY"));
    const std::size_t at = point.find(',');
    if (at != std::string::npos) point[at] = '.';
    from = point.data();
    to = from + point.size();
  }
  const auto result = std::from_chars(from, to, value);
  if (result.ec == std::errc::invalid_argument) return p;
  const auto length = static_cast<std::size_t>(result.ptr - from);
  if (result.ec == std::errc::result_out_of_range) value = out_of_range({from, length});
  const char* const next = start + length;
  if (next < end && *next == '#' && next[-1] == '.') {
    if (const char* after = after_microsoft_nan(next, end)) {
      value = std::numeric_limits<double>::quiet_NaN();
      return after;
    }
  }
  return next;
}

}  // namespace arris::files
