#include "acquisition/files/source.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace arris::files {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

Error bad_file(const Source& source, const std::string& what, const std::string& at, const std::string& found,
               const std::string& needed, const std::string& next) {
  const std::string where = at.empty() ? source.name : source.name + ", " + at;
  return {Fault::kInput, ErrorText{what, where, found, needed, next}};
}

std::string printable(std::string_view text, std::size_t longest) {
  std::string line(text.substr(0, longest));
  for (char& c : line)
    if (c < ' ' || c == 127) c = '?';
  if (text.size() > longest) line += "..";
  return line;
}

std::string quoted(std::string_view text, std::size_t longest) {
  std::string result = "'";
  result += printable(trimmed(text), longest);
  result += '\'';
  return result;
}

std::string line_of(const Source& source, const char* place) {
  const char* const end = source.bytes.data() + source.bytes.size();
  if (std::less<>()(place, source.bytes.data()) || std::less<>()(end, place)) return {};
  const auto lines = std::count(source.bytes.data(), place, '\n');
  return "line " + std::to_string(lines + 1);
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string unit_of_word(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> kWords[] = {{"mm", "mm"},
                                                                             {"millimeter", "mm"},
                                                                             {"millimeters", "mm"},
                                                                             {"millimetre", "mm"},
                                                                             {"millimetres", "mm"},
                                                                             {"cm", "cm"},
                                                                             {"centimeter", "cm"},
                                                                             {"centimeters", "cm"},
                                                                             {"centimetre", "cm"},
                                                                             {"centimetres", "cm"},
                                                                             {"m", "m"},
                                                                             {"meter", "m"},
                                                                             {"meters", "m"},
                                                                             {"metre", "m"},
                                                                             {"metres", "m"},
                                                                             {"um", "um"},
                                                                             {"micron", "um"},
                                                                             {"microns", "um"},
                                                                             {"micrometer", "um"},
                                                                             {"micrometers", "um"},
                                                                             {"micrometre", "um"},
                                                                             {"micrometres", "um"},
                                                                             {"in", "inch"},
                                                                             {"inch", "inch"},
                                                                             {"inches", "inch"},
                                                                             {"ft", "ft"},
                                                                             {"foot", "ft"},
                                                                             {"feet", "ft"}};
  const std::string small = lower(word);
  for (const auto& [name, unit] : kWords)
    if (small == name) return std::string(unit);
  return {};
}

std::string unit_in(std::string_view comment) {
  const std::string small = lower(comment);
  std::size_t at = small.find("unit");
  while (at != std::string::npos) {
    std::size_t next = at + 4;
    if (next < small.size() && small[next] == 's') ++next;
    // The first word after "unit", "unit =", "unit is", "units:".
    for (int word = 0; word < 2; ++word) {
      while (next < small.size() && !is_letter(small[next])) ++next;
      std::size_t end = next;
      while (end < small.size() && is_letter(small[end])) ++end;
      std::string unit = unit_of_word(std::string_view(small).substr(next, end - next));
      if (!unit.empty()) return unit;
      next = end;
    }
    at = small.find("unit", at + 4);
  }
  return {};
}

std::size_t saturated_product(std::size_t a, std::size_t b) {
  std::size_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? std::numeric_limits<std::size_t>::max() : product;
}

}  // namespace arris::files
