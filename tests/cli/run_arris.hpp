#pragma once

#include <filesystem>
#include <string>

namespace arris::testing {

/// What a run of the real program gave.
struct Ran {
  int code = -1;  ///< exit code; 128 + signal when one ended it
  std::string out, err;
};

/// Runs `arris ARGUMENTS` through the shell, in `folder`; arguments may go on with a pipe or further
/// commands.
[[nodiscard]] Ran run_arris(const std::string& arguments, const std::filesystem::path& folder = ".");

/// A folder of its own for one test, empty at the start, removed at the end.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file in it and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

[[nodiscard]] std::string text_of(const std::filesystem::path& file);

}  // namespace arris::testing
