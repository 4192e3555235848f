#include "tests/arch/source_text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace arris::arch {
namespace {

bool ends_with_any(std::string_view path, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view e) { return path.ends_with(e); });
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

void blank(std::string& text, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < std::min(end, text.size()); ++i)
    if (text[i] != '\n') text[i] = ' ';
}

// One past the end of the literal that opens at `begin`: "..", '..' or R"tag(..)tag".
std::size_t literal_end(const std::string& text, std::size_t begin) {
  if (text[begin] == '"' && begin > 0 && text[begin - 1] == 'R') {
    const std::size_t open = text.find('(', begin);
    if (open == std::string::npos) return text.size();
    const std::string close = ")" + text.substr(begin + 1, open - begin - 1) + "\"";
    const std::size_t found = text.find(close, open);
    return found == std::string::npos ? text.size() : found + close.size();
  }
  std::size_t i = begin + 1;
  while (i < text.size() && text[i] != text[begin] && text[i] != '\n') i += text[i] == '\\' ? 2 : 1;
  return std::min(i + 1, text.size());
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool is_written_by_people(std::string_view path) {
  return is_program_text(path) || path.ends_with("CMakeLists.txt") ||
         ends_with_any(path, {".cmake", ".py", ".sh", ".js", ".css", ".html"});
}

}  // namespace

bool is_header(std::string_view path) {
  return ends_with_any(path, {".hpp", ".h"});
}
bool is_program_text(std::string_view path) {
  return is_header(path) || ends_with_any(path, {".cpp", ".cc", ".c"});
}

std::string without_comments(std::string_view source, bool keep_literals) {
  std::string text(source);
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view two = std::string_view(text).substr(i, 2);
    const bool digit_separator = text[i] == '\'' && i > 0 && is_word(text[i - 1]);
    std::size_t end = i + 1;
    if (two == "//") {
      end = std::min(text.find('\n', i), text.size());
      blank(text, i, end);
    } else if (two == "/*") {
      const std::size_t close = text.find("*/", i + 2);
      end = close == std::string::npos ? text.size() : close + 2;
      blank(text, i, end);
    } else if ((text[i] == '"' || text[i] == '\'') && !digit_separator) {
      end = literal_end(text, i);
      if (!keep_literals) blank(text, i + 1, end - 1);
    }
    i = end;
  }
  return text;
}

std::vector<Include> includes_of(const SourceFile& file) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>))re");
  std::vector<Include> includes;
  std::istringstream lines(without_comments(file.text, true));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    includes.push_back({number, match[1].matched, match[1].matched ? match[1].str() : match[2].str()});
  }
  return includes;
}

int line_of(std::string_view text, std::size_t position) {
  return 1 + static_cast<int>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
}

std::vector<SourceFile> read_tree(const std::string& root) {
  namespace fs = std::filesystem;
  static const std::set<std::string> kFolders{"acquisition", "registration", "toolpath", "report", "cli",
                                              "tests",       "fixtures",     "cmake",    "docs"};
  std::vector<SourceFile> files;
  for (const std::string& folder : kFolders) {
    const fs::path top = fs::path(root) / folder;
    if (!fs::is_directory(top)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(top)) {
      const std::string path = fs::relative(entry.path(), root).generic_string();
      if (entry.is_regular_file() && is_written_by_people(path))
        files.push_back({path, read_text(entry.path())});
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace arris::arch
