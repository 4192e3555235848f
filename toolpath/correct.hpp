#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "acquisition/geometry/surface_query.hpp"
#include "registration/deformation_field.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// Limits of a correction (recipe [tolerance], [toolpath]); over them the path is refused, never clipped.
struct CorrectOptions {
  double max_correction_mm = 20.0;  ///< shift beyond the rigid motion, air moves included; > 0
  double max_tilt_rad = 0.35;       ///< turn of the tool axis beyond the rigid motion; in (0, pi]
  double max_step_ratio = 1.5;  ///< a step may differ from the nominal step, carried along, by this less 1
                                ///< times its length ...
  double step_slack_mm = 0.5;   ///< ... plus this; more is a jump or a fold. >= 1 and >= 0
  double path_reach_mm = 30.0;  ///< farther from the part: air move; > 0
  double far_face_mm = 0.0;  ///< the path runs on the face this far behind the CAD's; 0: on the CAD's; >= 0
  int threads = 1;           ///< 0: all cores; the same bytes for any number
  void check() const;        ///< throws Error(kRecipe) that names field, value and bound
};

/// One corrected row, beside its nominal row.
struct CorrectedPoint {
  PathPoint point;               ///< scan frame, local (cloud offset not added)
  double shift_mm = 0.0;         ///< length of the move beyond the rigid motion
  double shift_normal_mm = 0.0;  ///< signed, along the surface normal, positive out of the material
  double shift_across_mm =
      0.0;  ///< signed, in the surface across the path: positive to the right of the travel seen
            ///< against the normal, which is the void where the path runs as contours do
  double sd_normal_mm = 0.0, sd_across_mm = 0.0, sd_along_mm = 0.0,
         sd_axis_rad = 0.0;       ///< of the tip; 0: unknown
  double tilt_rad = 0.0;          ///< turn of the axis beyond the rigid motion
  double foot_distance_mm = 0.0;  ///< of the nominal tip from the face that the path runs on
  bool has_place = false;  ///< false: the field gave none; the row stands where the rigid motion puts it
  bool from_data = false;
  bool air_move = false;
  std::ptrdiff_t anchor =
      -1;  ///< the row whose motion this one takes: itself, of an air move the row it follows
};

/// The correction: result (i) of a run. ACCEPTED when reasons is empty.
struct Correction {
  std::vector<CorrectedPoint> points;  ///< same number and order as the nominal path
  std::vector<std::string> reasons;    ///< why it is refused, in plain words
  std::vector<std::string> notes;      ///< worth a line, no reason to refuse: "12 rows are air moves ..."
  std::string source;
  [[nodiscard]] bool accepted() const { return reasons.empty() && !points.empty(); }
};

/// Carries a nominal path FORWARD by the field. The foot of a row on the CAD decides where it belongs; the
/// offset from foot to tip and the axis are carried rigidly by the field's local rotation, so radius and
/// depth stay true on a bent edge. Rows farther than path_reach_mm are air moves: they take the motion of the
/// row that is nearest along their polyline and not one (of another polyline where theirs has none).
///   keeps     number, order, polyline, feed and closedness of the rows, and each tip's distance to its foot
///   changes   tip and axis
///   refuses   with the rows named (rows count from 1, s along the polyline): a row outside the field's
///   domain, a
///             place that is not finite, shift, tilt or step over its limit. Refused rows without a place of
///             their own stand where the rigid motion puts them: a diagnosis, not a path
///   throws    Error(kInput): an empty path, a row that is not finite or has no unit axis, no row within
///   reach of the
///             CAD; Error(kRecipe) from options.check(); Error(kBug) for a field whose rotation is none
/// A path on the far face (far_face_mm) keeps its feet on the CAD's face, through the thickness: the fibre
/// from foot to tip turns with the deformed normal and keeps its length. Reach is counted from the far face,
/// and "out of the material" is out of that face. The shift is resolved in the nominal surface's frame at the
/// foot, turned by the rigid motion. The sd of the tip adds the axis's sd times the lever from foot to tip.
/// Cost O(N log n).
[[nodiscard]] Correction correct(const ToolPath& nominal, const SurfaceQuery& cad,
                                 const DeformationField& field, const RigidMotion& scan_from_cad,
                                 const CorrectOptions& options);

/// What correct() throws of a path before it knows a scan: nothing when some row lies within reach of the
/// CAD.
void check_path_belongs(const ToolPath& nominal, const SurfaceQuery& cad, const CorrectOptions& options);

}  // namespace arris
