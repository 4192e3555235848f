#pragma once

#include <vector>

#include "registration/deformation_field.hpp"
#include "registration/edge_fit.hpp"
#include "registration/projection_model.hpp"

namespace arris {

/// What a model leaves between the nominal contour as it carries it and the scan, over the seen part.
struct ProjectionResidual {
  /// Along the normal, against the smooth height of the scan along the contour: the spline, which so leaves
  /// nothing of it.
  double height_rms_mm = 0.0, height_max_mm = 0.0;
  double across_rms_mm = 0.0, across_max_mm = 0.0;  ///< in the surface: what no projection can follow
  double tilt_rms_rad = 0.0;                        ///< slope of the height across the contour
};

/// One contour's model, with the edge found relative to the rigid motion and what is left.
struct ContourProjection {
  EdgeFit edge;
  ProjectionFit fit;
  ProjectionResidual residual = {};
};

/// Fits the model that the options ask for to contour c and measures what it leaves. O(scan points).
///   edge   of the same contour, fitted relative to scan_from_cad
[[nodiscard]] ContourProjection project_contour(const CadModel& cad, std::size_t contour,
                                                const ScanModel& scan, const RigidMotion& scan_from_cad,
                                                const EdgeFit& edge, const ProjectionOptions& options);

/// The modelled height of the nominal contour itself at s.
[[nodiscard]] SurfaceHeight contour_height(const Curve& contour, const ProjectionModel& model, double arc_mm);

/// The map of method `projection`, within band_mm of the contours. Repaired eq. 4: printed is
/// gamma_i = f(R C_i + T), although f was called a deformation; here
///   gamma_i = R C_i + T + f(..) n,   n = the registered normal,
/// and the axis turns with the slope of f (the paper's "normals should be computed again"). Points do not
/// move in the surface: an edge that did is not followed, and widens the stated deviation across. Points over
/// or under the face keep their distance from it.
class ProjectionField final : public DeformationField {
 public:
  ProjectionField(const CadModel& cad, const RigidMotion& scan_from_cad,
                  std::vector<ContourProjection> contours, double band_mm);

  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p_cad_mm) const override;
  [[nodiscard]] std::string method() const override { return "projection"; }
  [[nodiscard]] std::vector<double> parameters() const override;

 private:
  std::vector<Curve> nominal_;
  RigidMotion scan_from_cad_;
  std::vector<ContourProjection> contours_;
  double band_mm_;
};

}  // namespace arris
