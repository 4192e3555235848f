#include "cli/drawing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/contour_file.hpp"
#include "acquisition/files/read_scan.hpp"
#include "acquisition/geometry/polyline.hpp"
#include "acquisition/geometry/surface_query.hpp"
#include "acquisition/types/error.hpp"
#include "cli/recipe_options.hpp"
#include "cli/scanned_face.hpp"
#include "cli/text_file.hpp"
#include "toolpath/formats/csv.hpp"
#include "toolpath/from_contour.hpp"

namespace arris {
namespace {

constexpr double kOnEdgeMm = 1.0;  // a contour file lies on the CAD's edge within this
constexpr double kLengthAgreesRatio = 0.05;

double signed_volume_mm3(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (const auto& t : mesh.triangles)
    six_volumes += mesh.vertices_mm[static_cast<std::size_t>(t[0])].dot(
        mesh.vertices_mm[static_cast<std::size_t>(t[1])].cross(
            mesh.vertices_mm[static_cast<std::size_t>(t[2])]));
  return six_volumes / 6.0;
}

[[noreturn]] void refuse_inverted(const Recipe& recipe, const std::string& found) {
  throw Error(Fault::kInput, {.what = "the CAD mesh is inverted",
                              .where = recipe.part.cad.string(),
                              .found = found,
                              .needed = "triangle normals that point out of the material",
                              .next = "flip the normals and export the mesh again"});
}

/// Normals of a path or contour against those of the mesh: most must agree.
void check_facing(const Recipe& recipe, const SurfaceQuery& surface,
                  const std::vector<Eigen::Vector3d>& points_mm, const std::vector<Eigen::Vector3d>& normals,
                  const std::string& what) {
  std::size_t agree = 0, against = 0;
  const std::size_t stride = std::max<std::size_t>(1, points_mm.size() / 200);
  for (std::size_t i = 0; i < points_mm.size() && i < normals.size(); i += stride) {
    const double reach_mm = recipe.toolpath.path_reach_mm + recipe.part.thickness_mm.value_or(0.0);
    const SurfacePoint foot = surface.closest(points_mm[i], reach_mm);
    if (foot.triangle < 0) continue;
    const double cosine = foot.normal.dot(normals[i]);
    agree += cosine > 0.2 ? 1 : 0;
    against += cosine < -0.2 ? 1 : 0;
  }
  if (against > 4 * agree && against > 3)
    refuse_inverted(recipe, std::to_string(against) + " of " + std::to_string(agree + against) + " " + what +
                                " against the mesh's normals");
}

std::string ids_of(const ContourSet& set) {
  std::string text;
  for (const FoundContour& found : set.found) {
    if (found.contour.id > 12) return text + ", ..";
    text += (text.empty() ? "" : ", ") + std::to_string(found.contour.id) + " (" +
            std::to_string(static_cast<long>(std::lround(found.length_mm))) + " mm)";
  }
  return text;
}

/// The loop of the mesh on which a contour of the recipe's file lies.
const FoundContour& loop_under(const Recipe& recipe, const ContourSet& loops, const Contour& wanted) {
  const double length = length_mm(wanted);
  double nearest_mm = 1e300;
  for (const FoundContour& loop : loops.found) {
    const Curve curve(loop.contour);
    double worst_mm = 0.0;
    const std::size_t stride = std::max<std::size_t>(1, wanted.points_mm.size() / 100);
    for (std::size_t i = 0; i < wanted.points_mm.size(); i += stride)
      worst_mm = std::max(worst_mm, curve.nearest(wanted.points_mm[i]).distance_mm);
    if (worst_mm < kOnEdgeMm && std::abs(length - loop.length_mm) < kLengthAgreesRatio * loop.length_mm)
      return loop;
    nearest_mm = std::min(nearest_mm, worst_mm);
  }
  throw Error(Fault::kInput,
              {.what = "the contour lies on no edge of the CAD",
               .where = recipe.contour.file.string(),
               .found = std::to_string(nearest_mm) + " mm from the nearest of the CAD's contours",
               .needed = "at most " + std::to_string(kOnEdgeMm) + " mm, over the whole loop",
               .next = "list the CAD's contours: arris contours " + recipe.part.cad.string()});
}

std::vector<Contour> accepted_by_id(const Recipe& recipe, const ContourSet& loops) {
  std::vector<Contour> accepted;
  const auto known = [&](int id) { return id >= 1 && id <= static_cast<int>(loops.found.size()); };
  for (const std::vector<int>* ids : {&recipe.contour.accept, &recipe.contour.reject})
    for (const int id : *ids)
      if (!known(id))
        throw Error(Fault::kRecipe, {.what = "the recipe names a contour that the CAD has not",
                                     .where = recipe.part.cad.string(),
                                     .found = "contour " + std::to_string(id),
                                     .needed = "one of " + ids_of(loops),
                                     .next = "look at them: arris contours " + recipe.part.cad.string()});
  for (const FoundContour& loop : loops.found) {
    const auto named = [&](const std::vector<int>& ids) {
      return std::find(ids.begin(), ids.end(), loop.contour.id) != ids.end();
    };
    const bool by_rejection = recipe.contour.accept.empty() && !recipe.contour.reject.empty();
    if (by_rejection ? !named(recipe.contour.reject) : named(recipe.contour.accept))
      accepted.push_back(loop.contour);
  }
  if (recipe.contour.accept.empty() && recipe.contour.reject.empty() && loops.found.size() == 1)
    accepted.push_back(loops.found.front().contour);
  return accepted;
}

std::vector<Contour> accepted_contours(const Recipe& recipe, const ContourSet& loops,
                                       const SurfaceQuery& surface) {
  if (loops.found.empty())
    throw Error(Fault::kInput, {.what = "the CAD has no contour",
                                .where = recipe.part.cad.string(),
                                .found = "no open border and no sharp edge that closes",
                                .needed = "the contour that the tool follows",
                                .next = "lower contour.sharp_edge_deg, or export the face with its opening"});
  if (recipe.contour.file.empty()) {
    std::vector<Contour> accepted = accepted_by_id(recipe, loops);
    if (accepted.empty())
      throw Error(Fault::kRecipe, {.what = "several contours and none accepted",
                                   .where = recipe.part.cad.string(),
                                   .found = ids_of(loops),
                                   .needed = "contour.accept or contour.file in the recipe",
                                   .next = "look at them: arris contours " + recipe.part.cad.string()});
    return accepted;
  }
  std::vector<Contour> accepted;
  for (const Contour& wanted : read_contours(recipe.contour.file, 1.0)) {
    check_facing(recipe, surface, wanted.points_mm, wanted.normals, "contour normals point");
    accepted.push_back(loop_under(recipe, loops, wanted).contour);
  }
  return accepted;
}

/// The rows of toolpath.file; none when the path is made from contours.
ToolPath path_of_file(const Recipe& recipe, std::vector<std::string>& notes) {
  if (recipe.toolpath.from_contour.given) return {};
  if (recipe.toolpath.file.empty())
    throw Error(Fault::kRecipe, {.what = "the recipe names no tool path",
                                 .where = "part " + recipe.part.number,
                                 .found = "neither toolpath.file nor [toolpath.from_contour]",
                                 .needed = "one of them",
                                 .next = "to judge the shape alone: arris inspect"});
  PathCsv read =
      read_path_csv(read_text_file(recipe.toolpath.file, "tool path"), recipe.toolpath.file.string());
  notes.insert(notes.end(), read.notes.begin(), read.notes.end());
  for (PathPoint& point : read.path.points)
    if (point.feed_mm_s == 0.0) point.feed_mm_s = recipe.toolpath.feed_mm_s;
  return std::move(read.path);
}

/// The axes leave the face that toolpath.face names.
void check_axes(const Recipe& recipe, const TriangleMesh& scanned, const ToolPath& path) {
  const double side = recipe.toolpath.face == "other" ? -1.0 : 1.0;
  std::vector<Eigen::Vector3d> tips_mm, axes;
  for (const PathPoint& point : path.points) {
    tips_mm.push_back(point.tip_mm);
    axes.push_back(side * point.axis);
  }
  check_facing(recipe, SurfaceQuery(scanned), tips_mm, axes,
               "tool axes (toolpath.face = \"" + recipe.toolpath.face + "\") point");
}

}  // namespace

Drawing read_drawing(const Recipe& recipe, bool want_path, int threads) {
  Drawing drawing;
  drawing.mesh = read_mesh(recipe.part.cad, unit_mm(recipe.part.cad_units));
  ContourSet loops = mesh_contours(drawing.mesh, contour_options(recipe, threads));
  drawing.notes = loops.notes;
  const bool closed = loops.found.empty() || loops.found.front().contour.source != "boundary";
  if (closed && signed_volume_mm3(drawing.mesh) < 0.0)
    refuse_inverted(recipe, "a closed mesh of negative volume");
  const SurfaceQuery surface(drawing.mesh);
  drawing.accepted = accepted_contours(recipe, loops, surface);
  const bool axes_decide = recipe.part.cad_is == "solid" && !recipe.toolpath.file.empty();
  if (want_path || axes_decide) drawing.path = path_of_file(recipe, drawing.notes);
  ScannedFace face = scanned_face(recipe, drawing.mesh, loops, drawing.accepted, drawing.path);
  if (want_path && recipe.toolpath.from_contour.given)
    drawing.path = path_from_contours(recipe.toolpath.face == "other" ? face.far : face.accepted,
                                      from_contour_options(recipe));
  drawing.mesh = std::move(face.mesh);
  drawing.accepted = std::move(face.accepted);
  drawing.others = std::move(face.others);
  drawing.thickness_mm = face.thickness_mm;
  drawing.face_lines = std::move(face.lines);
  if (want_path)
    check_axes(recipe, drawing.mesh, drawing.path);
  else
    drawing.path = {};
  return drawing;
}

}  // namespace arris
