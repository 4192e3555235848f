#pragma once

#include <string>

#include "toolpath/robot/program.hpp"

namespace arris {

/// Throws Error(kRecipe) for names, signal numbers and work_points that a V+ program cannot have: see
/// write_vplus. V+ takes names of 15 characters and cuts longer ones without a word.
void check_vplus_names(const Program& program);

/// Name of a program that belongs to `program`: "<program>.<suffix>". Error(kRecipe) beyond 15 characters.
[[nodiscard]] std::string vplus_part_name(const std::string& program, const std::string& suffix);

}  // namespace arris
