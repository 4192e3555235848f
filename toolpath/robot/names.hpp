#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// What a robot language takes for a name; it knows no case.
struct NameRules {
  const char* language;
  std::string_view signs;  ///< beside letters and digits, not in front
  const char* in_words;    ///< "letters, digits and underscores"
  std::size_t longest;
  std::set<std::string> reserved;         ///< in lower case
  std::vector<std::string> numbered;      ///< stems of the names that the writer makes: stem1, stem2, ...
  std::set<std::string> predefined = {};  ///< reserved names that the controller has already
};

/// ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string text);

/// Checks the names of a cell one after another.
class NameCheck {
 public:
  explicit NameCheck(NameRules rules) : rules_(std::move(rules)) {}

  /// Throws Error(kRecipe) that names cell field and bound: no name of the language, a reserved one (but for
  /// predefined ones where the cell only refers to them), one that the writer uses or another field has.
  void take(const std::string& field, const std::string& name, bool may_be_predefined = false);

 private:
  NameRules rules_;
  std::set<std::string> used_;
};

}  // namespace arris
