#include "tests/support/bench_program.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>

#include "acquisition/types/error.hpp"

namespace arris::bench {
namespace {

/// The line that begins or ends what a program writes.
std::string marker(const std::string& which, const std::string& section) {
  return "<!-- " + which + ": " + (section.empty() ? "" : section + ", ") + "written by ./run bench -->\n";
}

}  // namespace

Words::Words(int argc, char** argv, const std::string& usage, const std::set<std::string>& with_value,
             const std::set<std::string>& flags) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (flags.contains(name)) {
      values_[name] = "yes";
      continue;
    }
    if (!with_value.contains(name)) throw Error(Fault::kUsage, "no option " + name + "\n" + usage);
    if (++i == argc) throw Error(Fault::kUsage, name + " needs a value\n" + usage);
    values_[name] = argv[i];
  }
}

std::string Words::text(const std::string& name, const std::string& otherwise) const {
  const auto found = values_.find(name);
  return found == values_.end() ? otherwise : found->second;
}

int Words::count(const std::string& name, int otherwise, int least) const {
  return has(name) ? std::max(least, std::atoi(text(name).c_str())) : otherwise;
}

int run_program(const std::function<void()>& work, std::ostream& errors) {
  try {
    work();
    return 0;
  } catch (const Error& error) {
    errors << error.what() << "\n";
    return exit_code(error.fault());
  } catch (const std::exception& error) {
    errors << error.what() << "\n";
    return 1;
  }
}

void put_between_markers(const std::filesystem::path& file, const std::string& text,
                         const std::string& section) {
  const std::string begin_line = marker("begin", section), end_line = marker("end", section);
  std::ifstream in(file, std::ios::binary);
  const std::string old{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::size_t begin = old.find(begin_line), end = old.find(end_line);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw Error(Fault::kInput, file.string() + " has no section to replace: the lines " + begin_line +
                                   "and " + end_line + "are needed");
  const std::size_t after_begin = begin + begin_line.size();
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << old.substr(0, after_begin) << "\n" << text << old.substr(end);
  out.close();
  if (!out) throw Error(Fault::kInput, "cannot write " + file.string());
}

}  // namespace arris::bench
