#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/arc_spline.hpp"
#include "registration/edge_fit.hpp"
#include "registration/scene.hpp"

namespace arris {

/// What the deformation near a contour is taken for (paper, section 2.2: "some function f").
enum class ProjectionKind {
  kPlane,     ///< the part lies flat now: its contour is projected onto the plane of the scan
  kParabola,  ///< z = alpha w^2 about one bending axis
  kSpline,    ///< a smooth height, and its slope across, along the contour
};

/// "plane", "parabola", "spline".
[[nodiscard]] std::string word_of(ProjectionKind kind);

/// Options of method `projection`. check() throws Error(kRecipe).
struct ProjectionOptions {
  ProjectionKind kind = ProjectionKind::kSpline;
  double distance_mm = 30.0;     ///< plane, parabola: scan points farther from the contour say nothing
  double max_residual_mm = 0.5;  ///< rms that the model may leave along the contour; more is refused
  int threads = 0;
  void check() const;
};

/// One scan point measured against the rigidly registered drawing; CAD frame. Repaired eq. 3: printed is
/// d_i = Q(X'_i) - X'_i, the drawing against its own plane Q, which no scan can change. Here
/// d_i = n . (y(X'_i) - X'_i) n: height_mm is the factor of n. X'_i is the foot of the scan point y, so that
/// a sparse scan is not read half a spacing too far, as a search from X'_i to its nearest point would.
struct HeightSample {
  Eigen::Vector3d foot_mm;
  Eigen::Vector3d normal;  ///< unit, out of the material
  double height_mm = 0.0;  ///< positive outside the material
};

/// The scan points within distance_mm of contour c whose foot lies on the face, not beyond its edge, and
/// whose normal agrees within 60 degrees (so no walls); in the scan's order, for any thread count.
[[nodiscard]] std::vector<HeightSample> measured_heights(const CadModel& cad, std::size_t contour,
                                                         const ScanModel& scan,
                                                         const RigidMotion& scan_from_cad, double distance_mm,
                                                         int threads);

/// Where a model is asked: a point of the drawing's face and its place beside the contour; CAD frame.
struct SurfacePlace {
  double arc_mm = 0.0;     ///< of the nearest place on the contour
  double across_mm = 0.0;  ///< from there into the material
  Eigen::Vector3d p_mm;
  Eigen::Vector3d normal, tangent, inward;  ///< unit, at that place of the contour
};

/// Height along the normal and its gradient in the surface.
struct SurfaceHeight {
  double mm = 0.0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  ///< mm per mm, normal to SurfacePlace::normal
};

/// The flat target, all that eq. 3 can mean: a plane, but of the scan. Height along n up to that plane.
struct FlatTarget {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  [[nodiscard]] SurfaceHeight at(const SurfacePlace& place) const;
};

/// z = alpha w^2. Repaired: printed w is undefined; here it is the distance from a bending axis that is
/// fitted as well, direction and position. What the rigid fit left of an offset and of a lean along the axis
/// is in it too:
///   f = offset + lean v + rise w + alpha w^2 = f0 + lean v + alpha (w - w0)^2,   w0 = -rise / (2 alpha)
/// with w and v measured across and along the axis in the plane through the contour's centre that is
/// perpendicular to its mean normal.
struct BentParabola {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d across_axis = Eigen::Vector3d::UnitX();  ///< direction of w
  Eigen::Vector3d along_axis = Eigen::Vector3d::UnitY();   ///< direction of v
  double offset_mm = 0.0, lean = 0.0, rise = 0.0;
  double alpha_per_mm = 0.0;
  double alpha_sd_per_mm = 0.0;  ///< for a residual that is white; one that is not is told as residual
  double axis_sd_rad = 0.0;
  double runner_up_ratio = 0.0;  ///< squares left by the best axis more than 45 degrees away, over these
  [[nodiscard]] SurfaceHeight at(const SurfacePlace& place) const;
  /// False where the part is hardly bent, or an axis across this one leaves less than 1.5 times the squares
  /// (a twist: bent up one way as much as down the other): then the axis means nothing.
  [[nodiscard]] bool axis_known() const;
  /// The point of the axis nearest to the centre, w0 from it; only where axis_known().
  [[nodiscard]] Eigen::Vector3d axis_point_mm() const;
};

/// Smooth height h(s) and slope across t(s) by arc length: f = h(s) + t(s) across.
struct HeightSpline {
  ArcSpline spline{1.0, false, 1.0};
  Eigen::VectorXd height_mm = Eigen::VectorXd::Zero(4), tilt_rad = Eigen::VectorXd::Zero(4);
  [[nodiscard]] SurfaceHeight at(const SurfacePlace& place) const;
};

using ProjectionModel = std::variant<FlatTarget, BentParabola, HeightSpline>;
[[nodiscard]] SurfaceHeight height_at(const ProjectionModel& model, const SurfacePlace& place);

/// A model of one contour's deformation; use it only if usable().
struct ProjectionFit {
  ProjectionModel model;
  std::size_t points = 0;  ///< scan points it was fitted to
  std::string reason;      ///< why there is none, in plain words
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// The plane of the scan, by iterated weighted least squares. Refuses fewer than 30 samples, and a drawing
/// whose face turns more than 60 degrees from that plane along the contour.
[[nodiscard]] ProjectionFit fit_flat_target(const Curve& contour, std::span<const HeightSample> samples);

/// The parabola, by iterated weighted least squares: for each direction of the axis the rest is linear, the
/// best direction is found on a grid of one degree and refined. Refuses fewer than 30 samples, and a contour
/// whose normals turn more than 60 degrees from their mean: it has no plane to measure w in. O(samples).
[[nodiscard]] ProjectionFit fit_bent_parabola(const Curve& contour, std::span<const HeightSample> samples);

/// Height and slope across of an edge fit made relative to the rigid motion.
[[nodiscard]] ProjectionFit height_spline_of(const EdgeFit& edge);

}  // namespace arris
