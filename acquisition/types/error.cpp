#include "acquisition/types/error.hpp"

namespace arris {

std::string to_line(const ErrorText& text) {
  std::string line = text.what;
  if (!text.where.empty()) line += " (" + text.where + ")";
  const char* separator = ": ";
  const auto add = [&](const char* label, const std::string& part) {
    if (part.empty()) return;
    line += separator;
    line += label + part;
    separator = "; ";
  };
  add("found ", text.found);
  add("needed ", text.needed);
  add("next: ", text.next);
  return line;
}

Error::Error(Fault fault, const ErrorText& text)
    : std::runtime_error(to_line(text)), fault_(fault), text_(std::make_shared<const ErrorText>(text)) {}
Error::Error(Fault fault, const std::string& line) : Error(fault, ErrorText{.what = line}) {}

int exit_code(Fault fault) {
  switch (fault) {
    case Fault::kUsage:
      return 2;
    case Fault::kInput:
    case Fault::kRecipe:
      return 3;
    case Fault::kDevice:
      return 6;
    case Fault::kInterrupted:
      return 130;
    case Fault::kBug:
      break;
  }
  return 1;
}

}  // namespace arris
