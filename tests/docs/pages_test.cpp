// The pages for people: their links resolve, and the commands, options and keys that they show exist.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace arris {
namespace {

namespace fs = std::filesystem;

struct Line {
  std::string page, text;
};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> pages() {
  const fs::path root = ARRIS_SOURCE_DIR;
  std::vector<fs::path> found;
  for (const fs::path& folder : {root, root / "docs", root / "fixtures", root / "fixtures" / "example"})
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".md") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

struct Ran {
  int code = -1;
  std::string out;
};

Ran run_arris(const std::string& arguments) {
  FILE* pipe = ::popen(("'" ARRIS_BINARY_DIR "/cli/arris' " + arguments + " 2>&1 </dev/null").c_str(), "r");
  Ran ran;
  if (pipe == nullptr) return ran;
  std::array<char, 4096> part{};
  for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    ran.out.append(part.data(), n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) ran.code = WEXITSTATUS(status);
  return ran;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Lines of code in the pages: indented by four blanks or fenced.
std::vector<Line> code_lines() {
  std::vector<Line> lines;
  for (const fs::path& page : pages()) {
    std::istringstream text(text_of(page));
    bool fenced = false;
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("```"))
        fenced = !fenced;
      else if (fenced || line.starts_with("    "))
        lines.push_back({page.filename().string(), line});
    }
  }
  return lines;
}

/// What follows `arris` or `./run arris` on the lines that begin with it.
std::vector<std::pair<Line, std::vector<std::string>>> program_calls() {
  std::vector<std::pair<Line, std::vector<std::string>>> calls;
  for (const Line& line : code_lines()) {
    std::vector<std::string> words = words_of(line.text);
    if (words.size() > 1 && words[0] == "./run") words.erase(words.begin());
    if (words.empty() || words[0] != "arris" || words.size() < 2 || words[1] == "...") continue;
    calls.push_back({line, {words.begin() + 1, words.end()}});
  }
  return calls;
}

TEST(Pages, LinksResolve) {
  const std::regex link(R"(\]\(([^)#]+)[^)]*\))");
  int checked = 0;
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    for (std::sregex_iterator it(text.begin(), text.end(), link), end; it != end; ++it) {
      const std::string target = (*it)[1];
      if (target.find("://") != std::string::npos) continue;
      EXPECT_TRUE(fs::exists(page.parent_path() / target)) << page.filename() << " -> " << target;
      ++checked;
    }
  }
  EXPECT_GT(checked, 15);
}

TEST(Pages, CommandsAndTheirOptionsExist) {
  EXPECT_GT(program_calls().size(), 10U);
  std::map<std::string, Ran> helps;
  for (const auto& [line, words] : program_calls()) {
    std::string command = words[0];
    if ((command == "recipe" || command == "calibrate") && words.size() > 1) command += " " + words[1];
    if (!helps.contains(command)) helps[command] = run_arris(command + " --help");
    const Ran& help = helps[command];
    EXPECT_EQ(help.code, 0) << line.page << ": " << line.text;
    EXPECT_NE(help.out.find("Usage: arris " + command + " "), std::string::npos)
        << line.page << ": " << line.text;
    for (const std::string& word : words)
      if (word.starts_with("--")) {
        EXPECT_NE(help.out.find(word), std::string::npos) << line.page << ": " << line.text;
      }
  }
}

/// The same run with its results in another folder, from the root of the sources.
Ran run_from_root(const std::vector<std::string>& words, const fs::path& out) {
  std::string arguments;
  for (std::size_t i = 0; i < words.size(); ++i)
    arguments += (i > 0 && words[i - 1] == "--out" ? "'" + (out / words[i]).string() + "'" : words[i]) + " ";
  const fs::path before = fs::current_path();
  fs::current_path(ARRIS_SOURCE_DIR);
  Ran ran = run_arris(arguments);
  fs::current_path(before);
  return ran;
}

/// A recipe for each role and each face: what README and guide tell people to copy is accepted as it stands.
TEST(Pages, ExamplesOfEachRoleAndFaceAreAccepted) {
  const fs::path out = fs::path(::testing::TempDir()) / ("arris_guide_" + std::to_string(::getpid()));
  fs::create_directories(out);
  std::map<std::string, std::set<std::string>> recipes;  // of each page
  std::set<std::vector<std::string>> tried;
  for (const auto& [line, words] : program_calls()) {
    if (words.size() < 2 || !words[1].starts_with("fixtures/guide/")) continue;
    recipes[line.page].insert(fs::path(words[1]).filename().string());
    if (!tried.insert(words).second) continue;  // both pages show it
    const Ran ran = run_from_root(words, out);
    EXPECT_EQ(ran.code, 0) << line.text << "\n" << ran.out;
  }
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(ARRIS_SOURCE_DIR) / "fixtures" / "guide"))
    for (const char* page : {"README.md", "process-engineer.md"}) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(entry.path().extension() != ".toml" || recipes[page].contains(name))
          << name << " is not in " << page;
    }
  fs::remove_all(out);
}

TEST(Pages, CommandsOfTheScriptExist) {
  const std::string script = text_of(fs::path(ARRIS_SOURCE_DIR) / "run");
  const std::regex call(R"(\./run ([a-z]+))");
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page);
    for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it)
      EXPECT_TRUE(std::regex_search(script, std::regex("\n  " + (*it)[1].str() + "( [^\n]*)?\\)")))
          << page.filename() << ": " << (*it)[0];
  }
}

/// Keys that `arris recipe print` prints, dotted; those that are commented out included.
std::set<std::string> keys_printed(const std::string& options) {
  std::set<std::string> keys;
  std::istringstream text(run_arris("recipe print " + options).out);
  const std::regex table(R"(^(?:# )?\[([a-z_.]+)\]$)"), key(R"(^(?:# )?([a-z_]+) = .*)");
  std::string in;
  std::smatch found;
  for (std::string line; std::getline(text, line);) {
    if (std::regex_match(line, found, table)) {
      in = found[1].str() + ".";
      keys.insert(found[1]);
    } else if (std::regex_match(line, found, key)) {
      keys.insert(in + found[1].str());
    }
  }
  return keys;
}

TEST(Pages, DottedKeysAreKeysOfTheRecipe) {
  const std::set<std::string> keys = keys_printed("");
  ASSERT_GT(keys.size(), 30U);
  const std::regex dotted(
      R"(`((?:part|scan|contour|toolpath|registration|tolerance|robot|cell)(?:\.[a-z_]+)+)( = [^`]*)?`)");
  int checked = 0;
  for (const fs::path& page : pages()) {
    const std::string text = text_of(page), name = page.filename().string();
    if (name == "README.md" && page.parent_path().filename() == "example") continue;  // names files
    for (std::sregex_iterator it(text.begin(), text.end(), dotted), end; it != end; ++it) {
      const std::string key = (*it)[1];
      if (fs::path(key).extension() == ".toml" || fs::path(key).extension() == ".csv") continue;
      EXPECT_TRUE(keys.contains(key)) << name << ": " << key;
      ++checked;
    }
  }
  EXPECT_GT(checked, 15);
}

/// Every `key = value` of the ```toml blocks, under the table it stands in.
TEST(Pages, TomlBlocksHaveKeysThatExist) {
  std::set<std::string> keys = keys_printed("");
  keys.merge(keys_printed("--cell"));
  const std::regex table(R"(^\[([a-z_.]+)\].*)"), key(R"(^([a-z_]+) = .*)");
  int checked = 0;
  for (const fs::path& page : pages()) {
    std::istringstream text(text_of(page));
    bool in_block = false;
    std::string in;
    std::smatch found;
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("```")) {
        in_block = line == "```toml";
        in.clear();
      } else if (in_block && std::regex_match(line, found, table)) {
        in = found[1].str() + ".";
      } else if (in_block && std::regex_match(line, found, key)) {
        EXPECT_TRUE(keys.contains(in + found[1].str())) << page.filename() << ": " << line;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 10);
}

}  // namespace
}  // namespace arris
