#include "tests/cli/run_arris.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <fstream>
#include <iterator>

namespace arris::testing {

TestFolder::TestFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "arris-test-XXXXXX").string();
  path_ = ::mkdtemp(pattern.data());
}

TestFolder::~TestFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TestFolder::write(const std::string& name, const std::string& text) const {
  std::filesystem::path file = path_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Ran run_arris(const std::string& arguments, const std::filesystem::path& folder) {
  const TestFolder capture;
  const std::string out = (capture.path() / "out").string(), err = (capture.path() / "err").string();
  const std::string command = "cd '" + folder.string() + "' && { '" ARRIS_BINARY_DIR "/cli/arris' " +
                              arguments + "\n} >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): one test a process
  Ran ran;
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ran.out = text_of(out);
  ran.err = text_of(err);
  return ran;
}

}  // namespace arris::testing
