#include "cli/solid_evidence.hpp"

#include <cmath>

#include "acquisition/geometry/polyline.hpp"
#include "acquisition/types/error.hpp"
#include "cli/recipe_options.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;

constexpr double kLeastCos = 0.2;  // a mean cosine nearer to zero says nothing

/// One witness: for each rim how far it says "on the scanned face", -1 to 1; 0: it does not know.
using Testimony = std::vector<double>;

Testimony of_seen_from(const Recipe& recipe, const std::vector<Contour>& rims) {
  Testimony says(rims.size(), 0.0);
  if (!recipe.scan.initial.given || recipe.scan.seen_from.size() != 3) return says;
  const Vector3d seen_from_mm(recipe.scan.seen_from[0], recipe.scan.seen_from[1], recipe.scan.seen_from[2]);
  const Vector3d eye_mm =
      motion_from_numbers("scan.initial.scan_from_cad", recipe.scan.initial.scan_from_cad).inverse() *
      seen_from_mm;
  for (std::size_t c = 0; c < rims.size(); ++c)
    for (std::size_t i = 0; i < rims[c].points_mm.size(); ++i)
      says[c] += rims[c].normals[i].dot((eye_mm - rims[c].points_mm[i]).normalized()) /
                 static_cast<double>(rims[c].points_mm.size());
  return says;
}

Testimony of_path(const Recipe& recipe, const std::vector<Contour>& rims, const ToolPath& path) {
  std::vector<Curve> curves(rims.begin(), rims.end());
  Testimony says(rims.size(), 0.0);
  std::vector<double> rows(rims.size(), 0.0);
  for (const PathPoint& row : path.points) {
    std::size_t nearest = 0;
    CurveFoot foot;
    foot.distance_mm = recipe.toolpath.path_reach_mm;
    for (std::size_t c = 0; c < curves.size(); ++c)
      if (const CurveFoot found = curves[c].nearest(row.tip_mm); found.distance_mm < foot.distance_mm)
        foot = found, nearest = c;
    if (foot.segment < 0) continue;
    says[nearest] += row.axis.dot(curves[nearest].normal(foot.arc_mm));
    rows[nearest] += 1.0;
  }
  const double side = recipe.toolpath.face == "other" ? -1.0 : 1.0;
  for (std::size_t c = 0; c < rims.size(); ++c) says[c] *= rows[c] > 0.0 ? side / rows[c] : 0.0;
  return says;
}

}  // namespace

std::vector<RimSide> sides_of_rims(const Recipe& recipe, const std::vector<Contour>& rims,
                                   const ToolPath& path) {
  const Testimony eye = of_seen_from(recipe, rims), axes = of_path(recipe, rims, path);
  std::vector<RimSide> sides;
  for (std::size_t c = 0; c < rims.size(); ++c) {
    const bool eye_speaks = std::abs(eye[c]) > kLeastCos, axes_speak = std::abs(axes[c]) > kLeastCos;
    if (eye_speaks && axes_speak && eye[c] * axes[c] < 0.0)
      throw Error(Fault::kRecipe,
                  {.what = "the recipe names two scanned faces",
                   .found = "contour " + std::to_string(rims[c].id) + " lies on the " +
                            (eye[c] > 0.0 ? "scanned" : "far") +
                            " face by scan.seen_from and scan.initial, and on the other one by the tool axes",
                   .needed = "axes out of the face that toolpath.face names",
                   .next = "check toolpath.face, scan.seen_from and scan.initial"});
    const double says = eye_speaks ? eye[c] : axes_speak ? axes[c] : 1.0;
    sides.push_back(says > 0.0 ? RimSide::kScanned : RimSide::kFar);
  }
  return sides;
}

}  // namespace arris
