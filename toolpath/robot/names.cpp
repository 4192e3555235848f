#include "toolpath/robot/names.hpp"

#include <algorithm>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using std::string;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool shaped(const NameRules& rules, const string& name) {
  return !name.empty() && name.size() <= rules.longest && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(), [&](char c) {
           return is_letter(c) || is_digit(c) || rules.signs.find(c) != std::string_view::npos;
         });
}

bool numbered(const NameRules& rules, const string& name) {
  return std::any_of(rules.numbered.begin(), rules.numbered.end(), [&](const string& stem) {
    return name.size() > stem.size() && name.compare(0, stem.size(), stem) == 0 &&
           std::all_of(name.begin() + static_cast<std::ptrdiff_t>(stem.size()), name.end(), is_digit);
  });
}

[[noreturn]] void refuse(const string& field, const string& name, const string& needed) {
  throw Error(Fault::kRecipe, "cell." + field + " = \"" + name + "\", need " + needed);
}

}  // namespace

string lower_case(string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

void NameCheck::take(const string& field, const string& name, bool may_be_predefined) {
  const string key = lower_case(name);
  const string language = rules_.language;
  if (!(may_be_predefined && rules_.predefined.count(key) > 0)) {
    if (!shaped(rules_, name))
      refuse(field, name,
             "a " + language + " name: a letter, then " + rules_.in_words + ", at most " +
                 std::to_string(rules_.longest));
    if (rules_.reserved.count(key) > 0 || numbered(rules_, key))
      refuse(field, name, "a name that " + language + " and the program leave free");
  }
  if (!used_.insert(key).second) refuse(field, name, "a name that no other field has");
}

}  // namespace arris
