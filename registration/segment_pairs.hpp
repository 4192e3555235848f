#pragma once

#include <vector>

#include "registration/scene.hpp"
#include "registration/segment_costs.hpp"
#include "registration/subdivision_icp.hpp"

namespace arris {

/// Middle of a segment, by arc length and as a point of the CAD: what its step turns about.
[[nodiscard]] double segment_middle_mm(const ContourMotion& motion, std::size_t segment);
[[nodiscard]] Eigen::Vector3d segment_pivot_mm(const ContourMotion& motion, std::size_t segment);

/// Columns: along, across (into the material) and normal to a contour at s; CAD frame.
[[nodiscard]] Eigen::Matrix3d contour_axes(const Curve& curve, double arc_mm);

/// Partners of the joint fit: which measured point belongs to which place of the part, under motions given.
/// References to cad, scan and data are kept.
class SegmentPairs {
 public:
  /// Chooses the stability points with the motions given, at most options.stability_points a segment.
  SegmentPairs(const CadModel& cad, const ScanModel& scan, const EdgeData& data,
               const std::vector<ContourMotion>& motions, const SubdivisionIcpOptions& options);

  /// Scan edge points at their foot on the carried contour; segments of contour c count from first[c].
  [[nodiscard]] std::vector<CarriedCost> edges(const std::vector<ContourMotion>& motions,
                                               const std::vector<std::size_t>& first) const;
  /// Stability points at their foot on the CAD; those whose foot is on its border or whose normals differ by
  /// more than 60 degrees are left out.
  [[nodiscard]] std::vector<CarriedCost> surface(const std::vector<ContourMotion>& motions,
                                                 const std::vector<std::size_t>& first) const;
  [[nodiscard]] static Carrier carrier(const ContourMotion& motion, std::size_t first, std::size_t segment,
                                       const Eigen::Vector3d& p_cad_mm, double weight);

 private:
  struct StabilityPoint {
    std::size_t contour = 0, scan_index = 0;
  };
  void choose_stability_points(const std::vector<ContourMotion>& motions);

  const CadModel& cad_;
  const ScanModel& scan_;
  const EdgeData& data_;
  const SubdivisionIcpOptions& options_;
  double sigma_normal_mm_;
  std::vector<StabilityPoint> stability_;
};

}  // namespace arris
