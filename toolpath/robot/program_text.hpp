#pragma once

#include <string>
#include <vector>

#include "toolpath/robot/program.hpp"

namespace arris {

/// What the writers of all robot languages have in common.

/// Printable ASCII in one line: blanks for tabs and line ends, '?' for everything else.
[[nodiscard]] std::string ascii_text(std::string text);

/// The comments at the head of a program, a line each behind `lead`: what was given, dry run, `note`,
/// result_hash; then `body_sha256 = ` without its digits and without the end of the line.
///   longest   characters of a line; a longer comment is cut. The hashes are not
[[nodiscard]] std::string head_text(const Program& program, const std::string& lead, const std::string& note,
                                    std::size_t longest = 200);

/// A speed with 3 decimals; throws Error(kRecipe) when it rounds to 0.
[[nodiscard]] std::string speed_text(double speed_mm_s);

/// The outputs that the program switches, each once, in the order of first use.
[[nodiscard]] std::vector<std::string> switched_outputs(const Program& program);

/// Whether the program switches any output.
[[nodiscard]] bool switches_outputs(const Program& program);

}  // namespace arris
