#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquisition/contour_extract.hpp"
#include "acquisition/types/contour.hpp"
#include "acquisition/types/triangle_mesh.hpp"
#include "cli/recipe.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// The drawing, reduced to the face that is scanned, and what the recipe takes from it: frame Cad, mm.
struct Drawing {
  TriangleMesh mesh;
  std::vector<Contour> accepted;        ///< loops of the mesh that the recipe accepts
  std::vector<Contour> others;          ///< its loops that are not accepted
  std::optional<double> thickness_mm;   ///< stated, or measured on a solid
  std::vector<std::string> face_lines;  ///< how the scanned face came out of the drawing; for the operator
  ToolPath path;                        ///< empty when none was asked for
  std::vector<std::string> notes;
};

/// Reads the CAD, its contours and the nominal tool path, and refuses what cannot be right.
///   throws  Error(kInput / kRecipe): files; an inverted mesh (a closed one with negative volume, or normals
///   against
///           the axes of path and contour file); no contour, or several and none accepted; an unknown id; a
///           contour file that lies on no edge of the CAD; no tool path although one is wanted
[[nodiscard]] Drawing read_drawing(const Recipe& recipe, bool want_path, int threads);

}  // namespace arris
