#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <ostream>
#include <set>
#include <string>

namespace arris::bench {

/// The words after a benchmark's name: "--seeds 5" and flags, which have the value "yes".
class Words {
 public:
  /// Throws Error(kUsage) with the usage line for a name that is in neither set, or one without its value.
  Words(int argc, char** argv, const std::string& usage, const std::set<std::string>& with_value,
        const std::set<std::string>& flags = {});
  [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }
  [[nodiscard]] std::string text(const std::string& name, const std::string& otherwise = "") const;
  [[nodiscard]] int count(const std::string& name, int otherwise, int least) const;

 private:
  std::map<std::string, std::string> values_;
};

/// Runs a benchmark; what it throws becomes a line on stderr and the exit code.
[[nodiscard]] int run_program(const std::function<void()>& work, std::ostream& errors);

/// Replaces what stands between the two marker lines of a section of a page (of its only one: no name).
/// Throws Error(kInput) when the page or a marker is missing, or it cannot be written.
void put_between_markers(const std::filesystem::path& file, const std::string& text,
                         const std::string& section = "");

}  // namespace arris::bench
