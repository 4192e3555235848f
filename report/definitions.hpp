#pragma once

#include <string>
#include <vector>

namespace arris::report {

/// A number's name and what exactly it is: the same words on the page and in result.json.
struct Definition {
  std::string name, meaning;
};
[[nodiscard]] const std::vector<Definition>& definitions();

}  // namespace arris::report
