#pragma once

#include "cli/commands.hpp"
#include "cli/recipe.hpp"

namespace arris {

/// Refuses to write over what is not ours to replace: --out may take the place of a contour choice, --png
/// that of a picture, and neither that of the input, the recipe or its drawing.
///   throws  Error(kInput), before anything is computed or written
void check_contours_outputs(const ContoursArgs& args, const Recipe& recipe);

}  // namespace arris
