#pragma once

#include <string>

namespace arris {

/// "arris 0.1.0": printed by --version and written into every result.
[[nodiscard]] std::string version();

}  // namespace arris
