#include "cli/version.hpp"

namespace arris {

std::string version() {
  return "arris " ARRIS_VERSION;
}

}  // namespace arris
