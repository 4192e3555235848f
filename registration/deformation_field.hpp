#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "acquisition/types/frames.hpp"

namespace arris {

/// Where one nominal point of the part lies now, as scanned and clamped.
struct MappedPoint {
  Eigen::Vector3d p_scan_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotation_scan_from_cad =
      Eigen::Matrix3d::Identity();  ///< local, orthonormal: carries axes, offsets
  Eigen::Vector3d sd_mm =
      Eigen::Vector3d::Zero();  ///< normal to the surface, across the contour, along it; 0: unknown
  double sd_axis_rad = 0.0;
  bool from_data = false;  ///< false: the prior (neighbours, rigid motion) decided, no scan point near
  bool in_domain = false;  ///< false: the field says nothing here; do not use the point
};

/// Map of material points: nominal CAD point -> where it is in the scan (FORWARD). Implemented by each
/// method.
class DeformationField {
 public:
  virtual ~DeformationField() = default;
  /// p_cad_mm: a point of the part's surface or edge (a foot point), CAD frame. Cost O(log n); thread-safe.
  [[nodiscard]] virtual MappedPoint map(const Eigen::Vector3d& p_cad_mm) const = 0;
  /// "rigid", "subdivision", ...: the name printed in results.
  [[nodiscard]] virtual std::string method() const = 0;
  /// Canonical numbers that define the field, for the result hash; rounded to 1e-6 by the caller.
  [[nodiscard]] virtual std::vector<double> parameters() const = 0;
};

/// The field of a part that did not deform: one motion everywhere.
class RigidField final : public DeformationField {
 public:
  explicit RigidField(const RigidMotion& scan_from_cad) : scan_from_cad_(scan_from_cad) {}
  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p_cad_mm) const override;
  [[nodiscard]] std::string method() const override { return "rigid"; }
  [[nodiscard]] std::vector<double> parameters() const override;

 private:
  RigidMotion scan_from_cad_;
};

}  // namespace arris
