#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "acquisition/geometry/surface_query.hpp"
#include "registration/deformation_field.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// Limits of a correction (recipe [tolerance], [toolpath]); over them the path is refused, never clipped.
struct CorrectOptions {
  double max_correction_mm = 20.0;     ///< shift beyond the rigid motion
  double max_tilt_rad = 0.35;          ///< turn of the tool axis beyond the rigid motion
  double max_step_ratio = 1.5;         ///< a step longer than this times the nominal step (+0.5 mm) is a jump
  double path_reach_mm = 30.0;         ///< farther from the part: air move
};

/// One corrected row, beside its nominal row.
struct CorrectedPoint {
  PathPoint point;                ///< scan frame, local (cloud offset not added)
  double shift_mm = 0.0;          ///< length of the move beyond the rigid motion
  double shift_normal_mm = 0.0;   ///< signed, along the surface normal
  double shift_across_mm = 0.0;   ///< signed, in the surface across the path
  double sd_normal_mm = 0.0, sd_across_mm = 0.0, sd_along_mm = 0.0, sd_axis_rad = 0.0;
  double tilt_rad = 0.0;
  bool from_data = false;
  bool air_move = false;
};

/// The correction: result (i) of a run. ACCEPTED when reasons is empty.
struct Correction {
  std::vector<CorrectedPoint> points;  ///< same number and order as the nominal path
  std::vector<std::string> reasons;    ///< why it is refused, in plain words
  std::string source;
  [[nodiscard]] bool accepted() const { return reasons.empty() && !points.empty(); }
};

/// Carries a nominal path FORWARD by the field. The foot of a row on the CAD decides where it belongs; the offset from
/// foot to tip and the axis are carried rigidly in the deformed frame, so radius and depth stay true on a bent edge.
/// Rows farther than path_reach_mm are air moves and follow the nearest row that is not. Refuses, with the rows named:
/// shift, tilt or step over its limit; a row outside the field's domain. Throws Error(kInput) when no row of the path
/// is within reach of the CAD.  Cost O(N log n).
[[nodiscard]] Correction correct(const ToolPath& nominal, const SurfaceQuery& cad, const DeformationField& field,
                                 const RigidMotion& scan_from_cad, const CorrectOptions& options);

}  // namespace arris
