#include "tests/arch/rules.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <set>

namespace arris::arch {
namespace {

// What each room may include, itself apart.
const std::map<std::string, std::set<std::string>>& doors() {
  static const std::map<std::string, std::set<std::string>> kDoors{
      {"types", {}},
      {"geometry", {"types"}},
      {"bridge", {"types"}},
      {"acquisition", {"types", "geometry", "bridge"}},
      {"registration", {"types", "geometry", "bridge"}},
      {"toolpath", {"types", "geometry", "registration"}},
      {"report", {"types", "geometry", "registration", "toolpath"}},
      {"fixtures", {"types"}},
      {"cli",
       {"types", "geometry", "bridge", "acquisition", "registration", "toolpath", "report", "fixtures"}},
      {"tests",
       {"types", "geometry", "bridge", "acquisition", "registration", "toolpath", "report", "fixtures",
        "cli"}}};
  return kDoors;
}

bool is_beneath(const std::string& path, const std::string& folder) {
  return path.starts_with(folder + "/");
}

bool holds_main(const std::string& bare_text) {
  static const std::regex kMain(R"(\bint\s+main\s*\()");
  return std::regex_search(bare_text, kMain);
}

// Position after the brace that closes the one at `open`.
std::size_t after_block(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '{') ++depth;
    if (text[i] == '}' && --depth == 0) return i + 1;
  }
  return text.size();
}

// Blanks what is inside brackets of any kind but <>, and ends function bodies with a semicolon, so that only
// the members themselves are left, one a semicolon.
std::string members_only(std::string body) {
  int depth = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    char& c = body[i];
    const bool opens = c == '{' || c == '(' || c == '[';
    const bool closes = c == '}' || c == ')' || c == ']';
    if (closes) --depth;
    const std::size_t next = body.find_first_not_of(" \n", i + 1);
    if (depth > 0 && c != '\n')
      c = ' ';
    else if (c == '}' && next != std::string::npos && body[next] != ',' && body[next] != ';')
      c = ';';
    if (opens) ++depth;
  }
  return body;
}

bool names_its_unit(const std::string& name) {
  static const std::regex kUnit(
      "_(mm|mm2|mm3|um|rad|deg|s|ms|hz|kg|px|dpi|ratio|sigmas)$");  // also mm_s, per_mm
  return std::regex_search(name, kUnit);
}

// Names and positions of the floating-point members (also in optional, vector, array and Eigen vectors) that
// do not end in a unit. A declaration with brackets but without '=' before them is a function.
std::vector<std::pair<std::string, std::size_t>> unitless_doubles(const std::string& body) {
  static const std::regex kDouble(R"(\b(?:double|float|Vector\dd|VectorXd)\b[\s>,\d]*\s(\w[^;]*)$)");
  static const std::regex kName(R"((?:^|,)\s*(\w+))");
  std::vector<std::pair<std::string, std::size_t>> found;
  std::size_t begin = 0;
  for (std::size_t end = body.find(';'); end != std::string::npos;
       begin = end + 1, end = body.find(';', begin)) {
    const std::string declaration = body.substr(begin, end - begin);
    if (declaration.find('(') < declaration.find('=')) continue;
    std::smatch match;
    if (!std::regex_search(declaration, match, kDouble)) continue;
    const std::string names = match[1].str();
    for (auto name = std::sregex_iterator(names.begin(), names.end(), kName); name != std::sregex_iterator();
         ++name)
      if (!names_its_unit((*name)[1].str()))
        found.emplace_back((*name)[1].str(), begin + static_cast<std::size_t>(match.position()));
  }
  return found;
}

}  // namespace

std::string to_text(const std::vector<Offence>& offences) {
  std::string text;
  for (const Offence& offence : offences)
    text += offence.path + ":" + std::to_string(offence.line) + ": " + offence.what + "\n";
  return text;
}

std::string room_of(const std::string& path) {
  for (const char* part : {"types", "geometry", "bridge"})
    if (is_beneath(path, std::string("acquisition/") + part)) return part;
  const std::string folder = path.substr(0, path.find('/'));
  return folder != path && doors().contains(folder) ? folder : "";
}

std::vector<Offence> check_doors(const SourceFile& file) {
  std::vector<Offence> offences;
  const std::string from = room_of(file.path);
  if (from.empty() || !is_program_text(file.path)) return offences;
  for (const Include& include : includes_of(file)) {
    const std::string to = room_of(include.target);
    if (to.empty()) {
      if (include.quoted && from != "tests")  // a test folder may name its own helpers
        offences.push_back(
            {file.path, include.line, "\"" + include.target + "\" is not a path from the root"});
      continue;
    }
    if (to != from && !doors().at(from).contains(to))
      offences.push_back(
          {file.path, include.line, from + " may not include " + include.target + " (" + to + ")"});
    else if (to == "bridge" && from != "bridge" && is_header(file.path))
      offences.push_back({file.path, include.line, "the bridge is for .cpp files: " + include.target});
  }
  return offences;
}

std::vector<Offence> check_quarantine(const SourceFile& file) {
  static const std::regex kForeign(
      R"(^(pcl|ceres|opencv2?|flann|boost|embree\d?|tbb|oneapi|nlohmann|fmt|cairo|CLI|toml\+\+|openssl)/)"
      R"(|^(vtk|gpiod|tbb|cairo|json\.hpp|toml\.hpp|CLI11))");
  std::vector<Offence> offences;
  if (!is_header(file.path) || room_of(file.path) == "bridge") return offences;
  for (const Include& include : includes_of(file))
    if (std::regex_search(include.target, kForeign))
      offences.push_back({file.path, include.line, "third-party header in a header: " + include.target});
  return offences;
}

std::vector<Offence> check_silence(const SourceFile& file) {
  static const std::regex kLoud(
      R"(\bstd::(cout|cerr|clog)\b|\b(v?printf|puts|putchar|perror)\s*\(|\bv?fprintf\s*\(\s*(stdout|stderr)\b)"
      R"(|\bfputs\s*\([^;]*\b(stdout|stderr)\b|\bfmt::(print|println)\s*\()"
      R"(|\b(exit|_exit|_Exit|quick_exit|abort|terminate)\s*\()");
  std::vector<Offence> offences;
  if (!is_program_text(file.path) || is_beneath(file.path, "cli")) return offences;
  const std::string bare = without_comments(file.text, false);
  const bool may_have_main = is_beneath(file.path, "tests") || is_beneath(file.path, "fixtures");
  if (may_have_main && holds_main(bare)) return offences;
  for (auto match = std::sregex_iterator(bare.begin(), bare.end(), kLoud); match != std::sregex_iterator();
       ++match)
    offences.push_back({file.path, line_of(bare, static_cast<std::size_t>(match->position())),
                        "prints or exits: " + match->str()});
  return offences;
}

std::vector<Offence> check_length(const SourceFile& file) {
  constexpr int kMostLines = 500;
  const auto lines = static_cast<int>(std::count(file.text.begin(), file.text.end(), '\n'));
  if (lines <= kMostLines) return {};
  return {{file.path, lines, std::to_string(lines) + " lines, at most " + std::to_string(kMostLines)}};
}

std::vector<Offence> check_units(const SourceFile& file) {
  static const std::regex kStruct(R"(\b(?:struct|class)\s+(\w*Options)\b[^;{()]*\{)");
  std::vector<Offence> offences;
  if (!is_program_text(file.path)) return offences;
  const std::string bare = without_comments(file.text, false);
  for (auto found = std::sregex_iterator(bare.begin(), bare.end(), kStruct); found != std::sregex_iterator();
       ++found) {
    const auto first = static_cast<std::size_t>(found->position() + found->length());
    const std::string body = members_only(bare.substr(first, after_block(bare, first - 1) - first - 1));
    for (const auto& [name, position] : unitless_doubles(body))
      offences.push_back({file.path, line_of(bare, first + position),
                          (*found)[1].str() + "::" + name + " does not end in a unit"});
  }
  return offences;
}

}  // namespace arris::arch
