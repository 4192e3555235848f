#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace arris {

/// Why a request could not be served; fixes the exit code of the program (ARCHITECTURE.md, "Exit codes").
enum class Fault {
  kBug,          ///< a broken promise inside our own code: exit 1
  kUsage,        ///< the command line: exit 2
  kInput,        ///< a file, or the machine's storage: exit 3
  kRecipe,       ///< a recipe, cell or option value: exit 3
  kDevice,       ///< GPIO, robot link, scanner: exit 6
  kInterrupted,  ///< Ctrl-C: exit 130
};

/// The five things an operator needs, in this order; empty parts are left out of the line.
struct ErrorText {
  std::string what = {};    ///< "the scan file ends early"
  std::string where = {};   ///< "part7.ply, byte 5120"
  std::string found = {};   ///< "820 of 1000 points"
  std::string needed = {};  ///< "1000 points, as its header says"
  std::string next = {};    ///< "export the scan again"
};

/// One line: "what (where): found ..; needed ..; next: ..".
[[nodiscard]] std::string to_line(const ErrorText& text);

/// What was asked for cannot be done. A result that is merely not good enough is no Error: it is a verdict.
class Error : public std::runtime_error {
 public:
  Error(Fault fault, const ErrorText& text);
  Error(Fault fault, const std::string& line);
  [[nodiscard]] Fault fault() const { return fault_; }
  [[nodiscard]] const ErrorText& text() const { return *text_; }  ///< its parts; a plain line is all "what"

 private:
  Fault fault_;
  std::shared_ptr<const ErrorText> text_;  // shared: copying an exception must not throw
};

[[nodiscard]] int exit_code(Fault fault);

}  // namespace arris
