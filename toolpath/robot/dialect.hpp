#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "toolpath/robot/program.hpp"
#include "toolpath/robot/reading.hpp"

namespace arris {

/// A robot language: its writer, and the recogniser that shares no code with it.
struct Dialect {
  const char* word;       ///< of the recipe's robot.controller
  const char* extension;  ///< of its files
  std::string (*write)(const Program& program,
                       const std::function<std::string(std::string_view)>& sha256_hex);
  Reading (*read)(std::string_view text, const std::string& source);
};

/// Every language that there is.
[[nodiscard]] const std::vector<Dialect>& dialects();

/// By its word; throws Error(kRecipe) for any other.
[[nodiscard]] const Dialect& dialect_from_name(const std::string& word);

/// Throws Error(kRecipe) for a cell whose names and lines this language cannot write, before there is a path:
/// programs without a move are written, with the tool's output switched off, and thrown away.
void check_cell(const Dialect& dialect, const Cell& cell);

}  // namespace arris
