#pragma once

#include <vector>

#include "acquisition/types/contour.hpp"
#include "cli/recipe.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// On which face of a solid a rim lies.
enum class RimSide { kScanned, kFar };

/// What the recipe states of each rim of a solid: scan.seen_from with scan.initial, then the axes of a tool
/// path from a file with toolpath.face; where neither speaks, the rim itself, which the recipe accepts, names
/// the scanned face.
///   rims   contours with normals, frame Cad
///   path   rows of toolpath.file, empty when there is none; air moves (path_reach_mm) do not count
///   throws Error(kRecipe): both speak and differ
[[nodiscard]] std::vector<RimSide> sides_of_rims(const Recipe& recipe, const std::vector<Contour>& rims,
                                                 const ToolPath& path);

}  // namespace arris
