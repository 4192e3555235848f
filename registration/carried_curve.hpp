#pragma once

#include <optional>

#include "registration/subdivision_icp.hpp"

namespace arris {

/// The nominal contour carried to the scan by its blended motion, with its nominal arc lengths kept. The
/// motion's own copy of the contour is used, and must outlive this.
class CarriedCurve {
 public:
  explicit CarriedCurve(const ContourMotion& motion);
  /// Nominal arc length of the foot of a scan point; O(log n).
  [[nodiscard]] double arc_of(const Eigen::Vector3d& p_scan_mm, double& distance_mm) const;
  /// The same, none beyond reach_mm; quicker.
  [[nodiscard]] std::optional<double> arc_within(const Eigen::Vector3d& p_scan_mm, double reach_mm) const;

 private:
  [[nodiscard]] double nominal_arc_mm(const CurveFoot& foot) const;

  const Curve& nominal_;
  Curve curve_;
};

}  // namespace arris
