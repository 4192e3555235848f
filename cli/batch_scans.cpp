#include "cli/batch_scans.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "acquisition/types/error.hpp"
#include "cli/batch_folder.hpp"
#include "cli/text_file.hpp"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLongestList = std::uintmax_t{256} << 20;

bool is_scan_name(const fs::path& file) {
  static const std::set<std::string> kEndings{".ply", ".pcd",  ".stl", ".off",
                                              ".xyz", ".xyzn", ".asc", ".pts"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return kEndings.contains(ending) && !file.filename().string().starts_with(".");
}

std::vector<fs::path> scans_in(const fs::path& folder, const std::vector<fs::path>& leave_out) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    std::error_code ignored;
    const fs::path& file = it->path();
    const bool left_out = std::any_of(leave_out.begin(), leave_out.end(), [&](const fs::path& other) {
      return fs::equivalent(file, other, ignored);
    });
    if (is_scan_name(file) && it->is_regular_file(ignored) && !left_out) found.push_back(file);
  }
  if (failed)
    throw Error(Fault::kInput, {"the folder of scans cannot be read", folder.string(), failed.message(),
                                "a folder that can be read", "check its permissions"});
  if (found.empty())
    throw Error(Fault::kInput, {"the folder holds no scan", folder.string(), "no file that ends as a scan",
                                "ply, pcd, stl, off, xyz, xyzn, asc or pts files",
                                "name the scans themselves, or a list of them: @list.txt"});
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<fs::path> scans_listed(const fs::path& list) {
  std::vector<fs::path> found;
  std::istringstream text(read_text_file(list, "list of scans", kLongestList));
  for (std::string line; std::getline(text, line);) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    line.erase(0, line.find_first_not_of(" \t"));
    if (!line.empty() && !line.starts_with("#")) found.emplace_back(line);
  }
  return found;
}

void append(const std::string& word, const std::vector<fs::path>& leave_out, std::vector<fs::path>& files) {
  std::vector<fs::path> found{word};
  std::error_code ignored;
  if (word.starts_with("@"))
    found = scans_listed(word.substr(1));
  else if (fs::is_directory(word, ignored))
    found = scans_in(word, leave_out);
  files.insert(files.end(), found.begin(), found.end());
}

/// The name of a file with `level` parts of its path in it; level 0 is the stem.
std::string name_at(const fs::path& file, std::size_t level) {
  if (level == 0) return file.stem().string();
  std::string name = file.filename().string();
  fs::path above = fs::absolute(file).lexically_normal().parent_path();
  for (; level > 1 && above.has_filename(); --level, above = above.parent_path())
    name.insert(0, above.filename().string() + "_");
  return name;
}

std::size_t most_levels(const fs::path& file) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  return static_cast<std::size_t>(std::distance(whole.begin(), whole.end()));
}

}  // namespace

std::vector<std::string> run_names(const std::vector<fs::path>& files,
                                   const std::vector<std::string>& taken) {
  std::vector<std::string> names(files.size());
  std::vector<std::size_t> level(files.size(), 0);
  for (bool again = true; again;) {
    again = false;
    std::map<std::string, int> uses;
    for (const std::string& name : taken) ++uses[name];
    for (std::size_t i = 0; i < files.size(); ++i) ++uses[names[i] = name_at(files[i], level[i])];
    for (std::size_t i = 0; i < files.size(); ++i)
      if (uses[names[i]] > 1 && level[i] < most_levels(files[i])) again = ++level[i] > 0;
  }
  std::set<std::string> used(taken.begin(), taken.end());
  for (std::string& name : names) {
    const std::string plain = name;
    for (int n = 2; !used.insert(name).second; ++n) name = plain + "-" + std::to_string(n);
  }
  return names;
}

std::vector<BatchScan> batch_scans(const std::vector<std::string>& words,
                                   const std::vector<fs::path>& leave_out) {
  std::vector<fs::path> all, files;
  for (const std::string& word : words) append(word, leave_out, all);
  std::set<fs::path> seen;
  for (const fs::path& file : all)
    if (seen.insert(fs::absolute(file).lexically_normal()).second) files.push_back(file);
  if (files.empty())
    throw Error(Fault::kInput, {"there is no scan to run", words.empty() ? "" : words.front(),
                                "a list without a path", "at least one scan", "write one path a line"});
  const std::vector<std::string> names = run_names(files, BatchFolder::reserved_names());
  std::vector<BatchScan> scans;
  for (std::size_t i = 0; i < files.size(); ++i) scans.push_back({files[i], names[i]});
  return scans;
}

}  // namespace arris
