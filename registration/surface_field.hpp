#pragma once

#include <vector>

#include "registration/arc_bins.hpp"
#include "registration/deformation_field.hpp"
#include "registration/scene.hpp"
#include "registration/surface_refine.hpp"

namespace arris {

/// Where along a contour scan points decided, in bins of kBinMm; empty: not known.
struct SeenAlong {
  static constexpr double kBinMm = 2.5;
  std::vector<char> bins;
  [[nodiscard]] bool at(double arc_mm) const {
    return bins.empty() || bins[arc_bin(arc_mm, kBinMm, bins.size())] != 0;
  }
};

/// The map of the surface field: a CAD point's foot is carried by the nodes' shifts, axes and offsets by the
/// deformed orthonormal frame there. With role `edge` points beside a contour follow the edge that was found:
/// its offset shifts them across. Standard deviations come from the fit's covariance.
class SurfaceField final : public DeformationField {
 public:
  /// cad must outlive the field.
  SurfaceField(const CadModel& cad, SurfaceFit fit, double band_mm, ContourRole role);
  void set_seen(std::vector<SeenAlong> seen) { seen_ = std::move(seen); }

  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p_cad_mm) const override;
  [[nodiscard]] std::string method() const override { return "surface"; }
  [[nodiscard]] std::vector<double> parameters() const override;
  [[nodiscard]] const SurfaceFit& fit() const { return fit_; }
  /// Motion of the material at a place of contour c, without the edge's own offset.
  [[nodiscard]] RigidMotion material_motion(std::size_t contour, double arc_mm) const;
  /// Covariance of the contour's mean shift; scan frame. Large along a motion that nothing holds.
  [[nodiscard]] Eigen::Matrix3d slide_covariance_mm2(std::size_t contour) const;

 private:
  [[nodiscard]] double sd_along_mm(const BasisRow& row, const Eigen::Vector3d& direction, int offset) const;
  /// Beyond the covariance: what the place owes along a direction to strain that all of the sheet may share.
  [[nodiscard]] double sd_strained_mm(const BasisRow& row, const Eigen::Vector3d& direction) const;
  /// Beyond the covariance: height that the nodes about this place do not follow; mm^2.
  [[nodiscard]] double unfollowed_mm2(const BasisRow& row) const;
  /// How the surface about a place turns.
  [[nodiscard]] Eigen::Matrix3d turn_about(const Eigen::Vector3d& foot_mm, const BasisRow& row) const;
  [[nodiscard]] double sd_tilt_rad(const BasisRow& row, const Eigen::Vector3d& inward,
                                   const Eigen::Vector3d& normal) const;

  const CadModel& cad_;
  SurfaceFit fit_;
  double band_mm_;
  ContourRole role_;
  std::vector<SeenAlong> seen_;
};

}  // namespace arris
