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

/// A drawing reduced to the face that the scanner sees; the rest of the program knows no other. Frame Cad.
struct ScannedFace {
  TriangleMesh mesh;              ///< normals out of the material, towards the scanner
  std::vector<Contour> accepted;  ///< their rims on the scanned face
  std::vector<Contour> others;    ///< the other rims of that face
  std::vector<Contour> far;  ///< the accepted rims on the far face, material on the left seen from there;
                             ///< filled when the path runs on that face and is made from contours
  std::optional<double> thickness_mm;  ///< the recipe's, or measured on a solid
  std::vector<std::string> lines;      ///< what the operator is told: which rims, how thick
};

/// Takes the scanned face out of what part.cad_is says the mesh is: the face itself, the other face or the
/// mid-surface (moved by part.thickness_mm or half of it; a mid-surface's normals point to the scanner), or a
/// solid.
///
/// A solid's scanned face is told, in this order, by scan.seen_from with scan.initial (which rim looks at
/// that point), by the axes of the tool path's file with toolpath.face, or by the rim that the recipe
/// accepts. Where the accepted rim lies on the far face, its partner on the scanned one is used and named.
///   loops, accepted   contours of the mesh as drawn, and those of them that the recipe accepts
///   path              rows of toolpath.file; empty when there is none
///   throws            Error(kInput / kRecipe): an open solid; a closed mesh that is said to be one face; a
///                     thickness that folds the face or is not the solid's; no rim on the face that is
///                     needed; the path and the start pose name different faces
[[nodiscard]] ScannedFace scanned_face(const Recipe& recipe, const TriangleMesh& drawn,
                                       const ContourSet& loops, const std::vector<Contour>& accepted,
                                       const ToolPath& path);

}  // namespace arris
