#include "cli/register_scan.hpp"

#include <cstdio>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

/// What makes a start pose impossible because the input is wrong, not because the data are poor.
void refuse_wrong_input(const CoarseAlignment& coarse, const Recipe& recipe) {
  const bool is_face = recipe.part.cad_is != "scanned_face";  // the face beyond is the mirror image
  if (coarse.inverted && !(coarse.mirrored && is_face))       // a nearly flat part is its own mirror image
    throw Error(
        Fault::kInput,
        {.what =
             std::string("the CAD mesh is inverted, or ") + (is_face ? "the scan shows the other face"
                                                             : coarse.mirrored ? "the scan is mirrored"
                                                                               : "the scan's normals are"),
         .found = coarse.reason,
         .needed =
             "triangle normals of the mesh and normals of the scan that point out of the material, and a "
             "right-handed scan of the face that the recipe names as scanned",
         .next =
             "look which way the mesh's normals point, then how the scan was exported; check part.cad_is"});
  if (coarse.mirrored)
    throw Error(
        Fault::kInput,
        {.what = is_face ? "the scan is mirrored, or shows the other face" : "the scan is mirrored",
         .found = "its mirror image fits the part, the scan itself does not",
         .needed = is_face ? "a right-handed scan of the face that the recipe names as scanned"
                           : "a right-handed scan of this part",
         .next = is_face ? "check part.cad_is, contour.accept and toolpath.face; or export the scan again"
                         : "export the scan again without mirroring, or take the drawing of the other hand"});
  if (coarse.no_points)
    throw Error(
        Fault::kInput,
        {.what = "no points in the band",
         .found = coarse.reason,
         .needed =
             recipe.contour.role == "cut"
                 ? "a scan that shows the outline or a datum hole of the drawing with its surroundings, "
                   "where scan.initial puts it"
                 : "a scan that shows the contour's surroundings (scan.initial, "
                   "registration.subdivision.band_mm)",
         .next = "check scan.initial, or leave it out to search for the pose"});
  if (coarse.unit_ratio == 1.0) return;
  char ratio[32];
  std::snprintf(ratio, sizeof ratio, "%g", coarse.unit_ratio);
  throw Error(Fault::kInput, {.what = "the scan is in another unit than the recipe says",
                              .found = std::string("contours that fit the CAD when scaled by ") + ratio,
                              .needed = "the file's unit in scan.units (it says " + recipe.scan.units + ")",
                              .next = "set scan.units in the recipe, or export the scan again"});
}

}  // namespace

Registration register_scan(const Recipe& recipe, const CadModel& cad, Measurement& measurement,
                           RegistrationOptions options) {
  if (options.coarse.initial_scan_from_cad)
    options.coarse.initial_scan_from_cad->pretranslate(-measurement.cloud.offset_mm);
  Registration found = register_part(cad, measurement.prepared.model, options);
  refuse_wrong_input(found.coarse, recipe);
  return found;
}

}  // namespace arris
