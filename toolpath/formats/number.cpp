#include "toolpath/formats/number.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "acquisition/types/error.hpp"

namespace arris {

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) throw Error(Fault::kBug, "a number to be written is not finite");
  std::array<char, 400> buffer;  // 309 digits of the largest double, sign, point, decimals
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  if (end.ec != std::errc()) throw Error(Fault::kBug, "a number to be written does not fit");
  std::string text(buffer.data(), end.ptr);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

}  // namespace arris
