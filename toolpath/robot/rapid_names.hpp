#pragma once

#include "toolpath/robot/program.hpp"

namespace arris {

/// Throws Error(kRecipe) unless every name of the cell can stand in a RAPID module of ours: a letter, then
/// letters, digits and underscores, at most 32; no word of the language; none of the names that the module
/// defines itself.
void check_rapid_names(const Program& program);

}  // namespace arris
