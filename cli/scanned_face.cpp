#include "cli/scanned_face.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "acquisition/offset_face.hpp"
#include "acquisition/solid_faces.hpp"
#include "acquisition/types/error.hpp"
#include "cli/recipe_options.hpp"
#include "cli/solid_evidence.hpp"

namespace arris {
namespace {

constexpr double kThicknessAgreesRatio = 0.02, kThicknessAgreesMm = 0.05;
constexpr double kEvenRatio = 0.05;  // a solid whose thickness spreads more has no one thickness

bool is_accepted(const std::vector<Contour>& accepted, int id) {
  return std::any_of(accepted.begin(), accepted.end(), [&](const Contour& c) { return c.id == id; });
}

std::string mm(double value_mm) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f mm", value_mm);
  return text;
}

bool runs_on_far_face(const Recipe& recipe) {
  return recipe.toolpath.face == "other";
}

[[noreturn]] void refuse_form(const Recipe& recipe, const std::string& found, const std::string& needed) {
  throw Error(Fault::kInput, {.what = "the CAD mesh is not what part.cad_is says",
                              .where = recipe.part.cad.string(),
                              .found = found,
                              .needed = needed,
                              .next = "set part.cad_is to what the mesh is, or export the mesh again"});
}

/// The scanned face and the far one, from a sheet drawn as one surface.
ScannedFace face_of_sheet(const Recipe& recipe, const TriangleMesh& drawn, const ContourSet& loops,
                          const std::vector<Contour>& accepted) {
  const double crease_rad = contour_options(recipe, 0).sharp_edge_rad;
  const double thickness_mm =
      recipe.part.thickness_mm.value_or(0.0);  // the recipe is checked: given where used
  const bool is_mid = recipe.part.cad_is == "mid", is_other = recipe.part.cad_is == "other_face";
  ScannedFace face{drawn, accepted, {}, {}, recipe.part.thickness_mm, {}};
  for (const FoundContour& loop : loops.found)
    if (!is_accepted(accepted, loop.contour.id)) face.others.push_back(loop.contour);
  if (is_mid || is_other) {
    const OffsetFace scanned = is_mid ? offset_face(drawn, 0.5 * thickness_mm, crease_rad)
                                      : turned(offset_face(drawn, -thickness_mm, crease_rad));
    face.mesh = scanned.mesh;
    face.accepted = contours_on(scanned, drawn, accepted);
    face.others = contours_on(scanned, drawn, face.others);
    face.lines.push_back(std::string("the drawing is the ") + (is_mid ? "mid-surface" : "other face") +
                         ": the scanned face lies " + mm(is_mid ? 0.5 * thickness_mm : thickness_mm) +
                         " from it");
  }
  if (!runs_on_far_face(recipe)) return face;
  if (is_other) {
    face.far = accepted;
  } else {
    const double down_mm = is_mid ? 0.5 * thickness_mm : thickness_mm;
    face.far = contours_on(turned(offset_face(drawn, -down_mm, crease_rad)), drawn, accepted);
  }
  return face;
}

/// The thickness behind the rims' face; the recipe's must agree with it.
std::optional<double> solid_thickness(const Recipe& recipe, const SolidFaces& solid, int face,
                                      std::vector<std::string>& lines) {
  const SolidThickness found = solid.thickness_behind(face);
  const bool even =
      found.known && found.spread_mm <= std::max(kThicknessAgreesMm, kEvenRatio * found.median_mm);
  const std::optional<double>& said_mm = recipe.part.thickness_mm;
  if (said_mm && even &&
      std::abs(*said_mm - found.median_mm) >
          std::max(kThicknessAgreesMm, kThicknessAgreesRatio * found.median_mm))
    throw Error(Fault::kRecipe,
                {.what = "part.thickness_mm is not the solid's thickness",
                 .where = recipe.part.cad.string(),
                 .found = mm(*said_mm) + " in the recipe, " + mm(found.median_mm) + " in the CAD",
                 .needed = "the same",
                 .next = "correct part.thickness_mm, leave it out, or check part.cad_units"});
  if (said_mm) return said_mm;
  if (even) {
    lines.push_back("the solid is " + mm(found.median_mm) + " thick behind its scanned face");
    return found.median_mm;
  }
  if (runs_on_far_face(recipe))
    throw Error(Fault::kRecipe, {.what = "the solid has no one thickness",
                                 .where = recipe.part.cad.string(),
                                 .found = mm(found.median_mm) + ", spread " + mm(found.spread_mm),
                                 .needed = "part.thickness_mm, with toolpath.face = \"other\"",
                                 .next = "write the thickness at the contour into the recipe"});
  return std::nullopt;
}

const Contour& partner_or_refuse(const Recipe& recipe, const SolidFaces& solid, const Contour& contour,
                                 const std::vector<Contour>& all, const std::string& wanted) {
  if (const Contour* partner = solid.partner_of(contour, all)) return *partner;
  throw Error(Fault::kInput,
              {.what = "contour " + std::to_string(contour.id) + " has no rim on the " + wanted + " face",
               .where = recipe.part.cad.string(),
               .found = "no contour at the other end of its walls that faces the other way",
               .needed = "a hole or an outline that goes through the part, with sharp rims",
               .next = "accept the rim on the scanned face, or lower contour.sharp_edge_deg"});
}

ScannedFace face_of_solid(const Recipe& recipe, const TriangleMesh& drawn, const ContourSet& loops,
                          const std::vector<Contour>& accepted, const ToolPath& path) {
  const SolidFaces solid(drawn, contour_options(recipe, 0).sharp_edge_rad);
  std::vector<Contour> all;
  for (const FoundContour& loop : loops.found) all.push_back(loop.contour);
  const std::vector<RimSide> sides = sides_of_rims(recipe, accepted, path);
  ScannedFace face;
  std::vector<int> faces;
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < accepted.size(); ++c) {
    const Contour& named = accepted[c];
    const bool is_far = sides[c] == RimSide::kFar;
    const Contour& rim = is_far ? partner_or_refuse(recipe, solid, named, all, "scanned") : named;
    if (is_far)
      face.lines.push_back("contour " + std::to_string(named.id) +
                           " lies on the far face; its rim on the scanned face, contour " +
                           std::to_string(rim.id) + ", is used");
    if (is_accepted(face.accepted, rim.id)) continue;  // both rims of a hole were accepted
    if (!is_far)
      face.lines.push_back("contour " + std::to_string(rim.id) + " lies on the scanned face; it is used");
    face.accepted.push_back(rim);
    faces.push_back(solid.face_of(rim));
    for (const Eigen::Vector3d& n : rim.normals) towards += n / static_cast<double>(rim.normals.size());
    if (runs_on_far_face(recipe) && recipe.toolpath.from_contour.given)
      face.far.push_back(is_far ? named : partner_or_refuse(recipe, solid, rim, all, "far"));
  }
  const std::vector<int> visible = solid.visible_with(faces, towards.normalized());
  face.mesh = solid.mesh_of(visible);
  for (const Contour& contour : all)
    if (!is_accepted(face.accepted, contour.id) &&
        std::binary_search(visible.begin(), visible.end(), solid.face_of(contour)))
      face.others.push_back(contour);
  face.thickness_mm = solid_thickness(recipe, solid, faces.front(), face.lines);
  return face;
}

}  // namespace

ScannedFace scanned_face(const Recipe& recipe, const TriangleMesh& drawn, const ContourSet& loops,
                         const std::vector<Contour>& accepted, const ToolPath& path) {
  const bool is_closed = loops.found.empty() || loops.found.front().contour.source != "boundary";
  const bool is_solid = recipe.part.cad_is == "solid";
  if (is_solid && !is_closed)
    refuse_form(recipe, "an open mesh, with one-face edges", "a closed mesh for cad_is = \"solid\"");
  const bool plain = recipe.part.cad_is == "scanned_face" && !runs_on_far_face(recipe);
  if (!is_solid && is_closed && !plain)
    refuse_form(
        recipe, "a closed mesh",
        "one face, open at its rims, for cad_is = \"" + recipe.part.cad_is + "\"; or cad_is = \"solid\"");
  return is_solid ? face_of_solid(recipe, drawn, loops, accepted, path)
                  : face_of_sheet(recipe, drawn, loops, accepted);
}

}  // namespace arris
