#pragma once

#include <vector>

#include "registration/deformation_field.hpp"
#include "registration/edge_fit.hpp"
#include "registration/subdivision_icp.hpp"

namespace arris {

/// What is known of one accepted contour after registration.
struct ContourResult {
  ContourMotion motion;  ///< subdivision ICP
  EdgeFit edge;          ///< found edge relative to the carried nominal
};

/// The map of subdivision ICP along the accepted contours, within band_mm of them. With follow_edge (role
/// `edge`) a contour point goes to the edge that was found; without it, to where the segments carry it.
class SubdivisionField final : public DeformationField {
 public:
  /// The CAD's contours are copied; density limits say how sharply an edge can be seen at all.
  SubdivisionField(const CadModel& cad, std::vector<ContourResult> contours, double band_mm,
                   bool follow_edge);

  [[nodiscard]] MappedPoint map(const Eigen::Vector3d& p_cad_mm) const override;
  [[nodiscard]] std::string method() const override { return "subdivision"; }
  [[nodiscard]] std::vector<double> parameters() const override;
  [[nodiscard]] const std::vector<ContourResult>& contours() const { return contours_; }

 private:
  std::vector<Curve> nominal_;
  std::vector<ContourResult> contours_;
  double band_mm_;
  bool follow_edge_;
};

}  // namespace arris
