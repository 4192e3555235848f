#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "acquisition/types/fixture_target.hpp"
#include "acquisition/types/frames.hpp"

namespace arris {

/// What the cell says of its targets.
struct TargetOptions {
  double max_residual_mm = 0.2;  ///< a target that fits worse is refused
  double point_sd_mm = 0.05;     ///< of a scanned point whose file states none, each axis
  double clear_mm = 25.0;        ///< scan points this near to a sphere found belong to its mount
  int threads = 0;
};

/// One target of the list, and how it was seen.
struct TargetSighting {
  FixtureTarget target;
  bool found = false;
  double residual_mm = 0.0;  ///< distance of its place in the list from where the scan has it, carried
  bool over_limit = false;
  Eigen::Vector3d scan_mm = Eigen::Vector3d::Zero();  ///< where the scan has it; frame of the points given
  double sd_mm = 0.0;                                 ///< of that place, each axis (root mean square)
  std::size_t points = 0;  ///< of a sphere: scan points that its centre was fitted to
};

/// The scanner's frame in the robot's base, from the targets of one scan. To be used only if usable().
struct TargetFrame {
  RigidMotion robot_from_scan = RigidMotion::Identity();  ///< frame of the points given
  /// Of the turn (rad) and the move (mm) of points about pivot_mm, robot's frame: a point p is in truth at
  /// p + move + turn x (p - pivot). From the places seen and the list's own, as stated.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d pivot_mm = Eigen::Vector3d::Zero();  ///< robot's frame: mean place of the targets found
  std::vector<TargetSighting> targets;                 ///< in the order of the list
  std::size_t extra = 0;                               ///< spheres and points that are no target of the list
  std::vector<std::int32_t> points;  ///< scan points on a sphere found or its mount, ascending
  std::vector<std::string> reasons;  ///< why it is not usable, in plain words
  std::vector<std::string> notes;    ///< worth a line
  double unit_ratio = 1.0;           ///< not 1: the list fits when it is scaled by this
  [[nodiscard]] bool usable() const { return reasons.empty(); }
};

/// Finds the targets of `list` in a scan and solves robot_from_scan. Spheres are found in the points, point
/// targets are those given; both are matched to the list by their distances to each other, whatever their
/// order, with some missing and strangers among them. Then Horn's closed form.
///   points_mm   scan points, targets among them; point targets in the same frame
///   refuses     fewer than three targets found or nearly on a line; two assignments that fit alike (targets
///               that look the same after a turn); a residual over its limit, with the name of the target
///               that does not fit the others where one can be told; a list in another unit (unit_ratio)
///   throws      Error(kBug): a point that is not finite
///   source      Horn, J. Opt. Soc. Am. A 4(4), 1987; covariance by propagation through its linear form
[[nodiscard]] TargetFrame solve_targets(std::span<const FixtureTarget> list,
                                        std::span<const Eigen::Vector3d> points_mm,
                                        std::span<const ScanTarget> point_targets,
                                        const TargetOptions& options);

/// Why a list can never give a frame: places that coincide, all nearly on a line, or a constellation that
/// looks the same after a turn. Empty: good.
[[nodiscard]] std::string why_list_is_unusable(std::span<const FixtureTarget> list, double max_residual_mm);

/// Covariance of a point of the robot's frame that was carried by the frame; mm^2.
[[nodiscard]] Eigen::Matrix3d carried_covariance_mm2(const TargetFrame& frame,
                                                     const Eigen::Vector3d& p_robot_mm);

}  // namespace arris
