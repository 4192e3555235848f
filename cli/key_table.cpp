#include "cli/key_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string whole_text(int value) {
  return fmt::format("{}", value);
}

template <class T, class Format>
std::string list_text(const std::vector<T>& values, Format format) {
  std::string text = "[";
  for (const T& value : values) text += (text.size() > 1 ? ", " : "") + format(value);
  return text + "]";
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string range_text(const Key& key) {
  const bool low = std::isfinite(key.min), high = std::isfinite(key.max);
  if (low && high && key.min == key.max) return fmt::format("{}", key.min);
  if (low && high) return fmt::format("{} to {}", key.min, key.max);
  if (low) return fmt::format("{} or more", key.min);
  if (high) return fmt::format("{} or less", key.max);
  return {};
}

/// What to do about a value that a key does not take.
std::string correct_it(const Key& key) {
  return key.required ? "correct it: " + key.about : "correct it, or leave it out for its default";
}

std::optional<ErrorText> check_number(const Key& key, double value) {
  if (!std::isfinite(value))
    return ErrorText{
        key.name + " is not a finite number", {}, fmt::format("{}", value), type_text(key), correct_it(key)};
  if (value < key.min || value > key.max)
    return ErrorText{
        key.name + " is out of range", {}, fmt::format("{}", value), range_text(key), correct_it(key)};
  return std::nullopt;
}

std::optional<ErrorText> check_text(const Key& key, const std::string& value) {
  if (key.required && value.empty())
    return ErrorText{key.name + " is empty", {}, "\"\"", type_text(key), "fill it in: " + key.about};
  if (key.words.empty() || contains(key.words, value)) return std::nullopt;
  if (contains(key.later, value))
    return ErrorText{key.name + " = " + quote(value) + " is not in this version yet",
                     {},
                     "a word of a later version",
                     "one of " + joined(key.words),
                     "use " + quote(key.words.front())};
  const std::string near = nearest_name(value, key.words);
  return ErrorText{key.name + " has no such choice",
                   {},
                   quote(value),
                   "one of " + joined(key.words),
                   near.empty() ? correct_it(key) : "did you mean " + quote(near) + "?"};
}

ErrorText empty_list(const Key& key) {
  return {key.name + " is empty", {}, "[]", type_text(key), "fill it in: " + key.about};
}

template <class T>
std::optional<ErrorText> check_list(const Key& key, const std::vector<T>& values) {
  if (key.required && values.empty()) return empty_list(key);
  if (!values.empty() && !key.lengths.empty() &&
      std::find(key.lengths.begin(), key.lengths.end(), values.size()) == key.lengths.end())
    return ErrorText{key.name + " has the wrong length",
                     {},
                     fmt::format("{} numbers", values.size()),
                     type_text(key),
                     correct_it(key)};
  for (const T value : values)
    if (auto problem = check_number(key, static_cast<double>(value))) return problem;
  return std::nullopt;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      cost[i][j] =
          std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  return cost[a.size()][b.size()];
}

/// "part" of "part.number"; "" of "schema".
std::string table_of(const std::string& name) {
  const auto dot = name.rfind('.');
  return dot == std::string::npos ? std::string() : name.substr(0, dot);
}

}  // namespace

std::optional<ErrorText> check_value(const Key& key) {
  return std::visit(
      Overloaded{[&](const std::string* value) { return check_text(key, *value); },
                 [&](const std::filesystem::path* value) { return check_text(key, value->string()); },
                 [&](const bool*) { return std::optional<ErrorText>(); },
                 [&](const int* value) { return check_number(key, *value); },
                 [&](const double* value) { return check_number(key, *value); },
                 [&](const std::optional<double>* value) {
                   return value->has_value() ? check_number(key, **value) : std::optional<ErrorText>();
                 },
                 [&](const std::vector<std::string>* texts) {
                   return key.required && texts->empty() ? empty_list(key) : std::optional<ErrorText>();
                 },
                 [&](const auto* values) { return check_list(key, *values); }},
      key.slot);
}

std::string value_text(const Key& key, const std::filesystem::path& folder) {
  const auto text_or = [&](bool empty, const std::string& nothing, const auto& text) {
    if (!empty) return text();
    return key.example.empty() ? nothing : std::string();
  };
  return std::visit(
      Overloaded{
          [&](const std::string* v) { return text_or(v->empty(), "\"\"", [&] { return quote(*v); }); },
          [&](const std::filesystem::path* v) {
            const bool move = !folder.empty();
            return text_or(v->empty(), "\"\"", [&] {
              return quote(move ? v->lexically_proximate(folder).string() : v->string());
            });
          },
          [](const bool* v) { return std::string(*v ? "true" : "false"); },
          [](const int* v) { return fmt::format("{}", *v); }, [](const double* v) { return number_text(*v); },
          [](const std::optional<double>* v) { return v->has_value() ? number_text(**v) : std::string(); },
          [&](const std::vector<int>* v) {
            return text_or(v->empty(), "[]", [&] { return list_text(*v, whole_text); });
          },
          [&](const std::vector<double>* v) {
            return text_or(v->empty(), "[]", [&] { return list_text(*v, number_text); });
          },
          [&](const std::vector<std::string>* v) {
            return text_or(v->empty(), "[]", [&] { return list_text(*v, quote); });
          }},
      key.slot);
}

std::string type_text(const Key& key) {
  const auto with_range = [&](const std::string& type) {
    const std::string range = range_text(key);
    return range.empty() ? type : type + ", " + range;
  };
  const auto list_type = [&](const std::string& type) {
    if (key.lengths.empty()) return with_range("a list of " + type);
    return with_range(fmt::format("{} {}", fmt::join(key.lengths, " or "), type));
  };
  return std::visit(
      Overloaded{[&](const std::string*) {
                   return key.words.empty() ? "a text in quotes" : "one of " + joined(key.words);
                 },
                 [](const std::filesystem::path*) { return std::string("a file name in quotes"); },
                 [](const bool*) { return std::string("true or false"); },
                 [&](const int*) { return with_range("a whole number"); },
                 [&](const double*) { return with_range("a number"); },
                 [&](const std::optional<double>*) { return with_range("a number"); },
                 [&](const std::vector<int>*) { return list_type("whole numbers"); },
                 [&](const std::vector<double>*) { return list_type("numbers"); },
                 [&](const std::vector<std::string>*) { return list_type("texts in quotes"); }},
      key.slot);
}

std::string print_keys(const std::vector<Key>& keys, const std::filesystem::path& folder,
                       const std::set<std::string>& absent) {
  std::string text, table;
  for (const Key& key : keys) {
    const bool new_table = table_of(key.name) != table;
    table = table_of(key.name);
    const bool off = absent.contains(table);
    if (new_table) text += fmt::format("\n{}[{}]\n", off ? "# " : "", table);
    const std::string value = value_text(key, folder);
    const std::string leaf = table.empty() ? key.name : key.name.substr(table.size() + 1);
    text += fmt::format("# {}{}  ({})\n", key.required ? "* " : "", key.about, type_text(key));
    text += fmt::format("{}{} = {}\n", value.empty() || off ? "# " : "", leaf,
                        value.empty() ? key.example : value);
  }
  return text;
}

std::string nearest_name(std::string_view wrong, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, wrong.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(wrong, name);
    if (distance >= best) continue;
    best = distance;
    nearest = name;
  }
  if (!nearest.empty() || wrong.size() < 3) return nearest;
  const auto begins = [&](const std::string& name) { return name.starts_with(wrong); };  // a unit left off
  const auto longer = std::find_if(names.begin(), names.end(), begins);
  return longer == names.end() ? std::string() : *longer;
}

std::string quote(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      result += c;
  }
  return result + "\"";
}

}  // namespace arris
