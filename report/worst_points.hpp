#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace arris::report {

/// One flag: the same id in picture, table and data.
struct WorstPoint {
  std::string id;         ///< "H1" the highest, "L1" the lowest, ...
  std::size_t index = 0;  ///< point of the cloud
  double deviation_mm = 0.0;
  Eigen::Vector3d p_scan_mm = Eigen::Vector3d::Zero();  ///< scan frame, the file's coordinates
  Eigen::Vector3d p_cad_mm = Eigen::Vector3d::Zero();   ///< the same point carried into the CAD frame
  Eigen::Vector3d nominal_cad_mm =
      Eigen::Vector3d::Zero();  ///< its foot on the CAD; read only if has_nominal
  bool has_nominal = false;     ///< the nearest CAD point lies at |deviation|
  bool in_tolerance = true;     ///< |d| <= surface_profile_mm / 2
};

/// Indices of the `count` largest values (positive = true) or smallest, at least min_distance_mm apart, worst
/// first. Only values of the asked sign; NaN is skipped; equal values: the lower index. Cost O(N count).
[[nodiscard]] std::vector<std::size_t> spaced_extremes(std::span<const Eigen::Vector3f> points_mm,
                                                       std::span<const float> deviation_mm, int count,
                                                       double min_distance_mm, bool positive);

/// Distance that the flags of a run keep: a fifth of the rms radius of the points with data, whatever the
/// pose; mm.
[[nodiscard]] double flag_spacing_mm(const RunRecord& record);

/// The flags of a run: up to count_each above and below, flag_spacing_mm() apart.
[[nodiscard]] std::vector<WorstPoint> worst_points(const RunRecord& record, int count_each = 5);

}  // namespace arris::report
