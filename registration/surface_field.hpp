#pragma once

#include <memory>
#include <vector>

#include "registration/deformation_field.hpp"
#include "registration/scene.hpp"
#include "registration/surface_refine.hpp"

namespace arris {

/// The map of the surface field: a CAD point's foot is carried by the nodes' shifts, axes and offsets by the
/// deformed orthonormal frame there. With role `edge` points beside a contour follow the edge that was found:
/// its offset shifts them across. Standard deviations come from the fit's covariance.
class SurfaceField final : public DeformationField {
 public:
  /// cad must outlive the field.
  SurfaceField(const CadModel& cad, SurfaceFit fit, double band_mm, bool follow_edge);

  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p_cad_mm) const override;
  [[nodiscard]] std::string method() const override { return "surface"; }
  [[nodiscard]] std::vector<double> parameters() const override;
  [[nodiscard]] const SurfaceFit& fit() const { return fit_; }
  /// Motion of the material at a place of contour c, without the edge's own offset.
  [[nodiscard]] RigidMotion material_motion(std::size_t contour, double arc_mm) const;

 private:
  [[nodiscard]] double sd_along_mm(const BasisRow& row, const Eigen::Vector3d& direction, int offset) const;

  const CadModel& cad_;
  SurfaceFit fit_;
  double band_mm_;
  bool follow_edge_;
};

}  // namespace arris
