#pragma once

#include <string>

namespace arris::report {

/// Fixed decimal text in the C locale, whatever the machine's: "-0.0004" with 2 digits is "0.00"; not finite:
/// "nan".
[[nodiscard]] std::string fixed_text(double value, int digits);

/// The same for people: what is not finite reads "no data".
[[nodiscard]] std::string people_text(double value, int digits);

/// With the minus of typesetting (UTF-8) and no plus.
[[nodiscard]] std::string minus_text(double value, int digits);

/// With a sign for values that do not round to zero: "+0.12", "0.00", and the minus of typesetting (UTF-8).
[[nodiscard]] std::string signed_text(double value, int digits);

/// Rounded to 1e-6, the precision of every number written; never minus zero. Not finite stays as it is.
[[nodiscard]] double rounded(double value);

/// 1234567 as "1 234 567" (thin spaces are left to the page).
[[nodiscard]] std::string grouped_text(std::size_t count);

/// Smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is at least `value`; 1 for value <= 0.
[[nodiscard]] double nice_at_least(double value);

/// Decimals needed to write multiples of `step` exactly (0 to 4).
[[nodiscard]] int digits_for_step(double step);

}  // namespace arris::report
