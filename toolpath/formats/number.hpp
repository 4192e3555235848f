#pragma once

#include <string>

namespace arris {

/// A number as files of this room write it: fixed notation, decimal point whatever the locale, never
/// "-0.000". Throws Error(kBug) for a value that is not finite: nothing of the kind may reach a file.
[[nodiscard]] std::string fixed_text(double value, int decimals);

}  // namespace arris
