#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/scene.hpp"

namespace arris {

/// Options of both rigid ICPs. check() throws Error(kRecipe).
struct RigidIcpOptions {
  int max_iterations = 60;          ///< k_max of the paper
  double stop_change_ratio = 1e-4;  ///< delta of the paper: stop when the rms changes by less than this share
  int surface_points = 2000;        ///< at most this many scan points are compared with the CAD surface
  double start_scale_mm = 20.0;     ///< robust scale at the start: about the error of the start pose
  double band_mm = 60.0;            ///< scan points farther from every contour are left out
  bool robust = true;  ///< annealed Geman-McClure weights; false: plain least squares within the band
  bool with_covariance = false;  ///< fill RigidIcpResult::covariance (icp_point_to_plane)
  int threads = 0;
  void check() const;
};

/// What a rigid ICP found, with what is needed to judge it; read the motion only if usable().
struct RigidIcpResult {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  double rms_mm = 0.0;       ///< over the pairs of the last round, weighted
  double edge_rms_mm = 0.0;  ///< weighted rms of edge points to the contour, across and normal; 0: not used
  double surface_rms_mm =
      0.0;  ///< weighted rms of scan points to the CAD surface, point to plane; 0: not used
  std::size_t pairs = 0;
  int iterations = 0;
  std::string stop;    ///< "converged", "iteration limit"
  std::string reason;  ///< why there is no result; empty when usable
  Eigen::Matrix<double, 6, 6> information =
      Eigen::Matrix<double, 6, 6>::Zero();             ///< unit-weight, about pivot_mm, Cad
  Eigen::Vector3d pivot_mm = Eigen::Vector3d::Zero();  ///< CAD frame
  /// Of a small motion of the part (turn in rad, then shift in mm) about pivot_mm, CAD axes; zero: not asked
  /// for. From how the pull on the pose scatters between stretches of the contour, some 100 mm each with the
  /// surface beside it, so misfit that is alike within a stretch counts once. In a direction that the data
  /// leave free: 1 rad, or what 1 rad moves.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// Inverse of an information matrix where the data determine the motion, and the covariance of the directions
/// that they leave free: 1 rad, or the reach_mm that a turn of 1 rad moves.
struct Determined {
  Eigen::Matrix<double, 6, 6> inverse, free;
};
[[nodiscard]] Determined determined(const Eigen::Matrix<double, 6, 6>& information, double reach_mm);

/// The paper's ICP (section 2.1): every model point, its nearest data point, Horn's closed form, repeat.
/// Repairs: Phi is the nearest POINT (the printed Phi is a distance); eq. 2 squares the norm; the loop goes
/// on WHILE the change exceeds delta AND k < k_max (both printed reversed); the motions are composed.
///   model_mm   contour points, CAD frame;  data   contour points of the scan
///   cost       O(iterations * N log M); deterministic
[[nodiscard]] RigidIcpResult icp_point_to_point(std::span<const Eigen::Vector3d> model_mm,
                                                const NearestPoints& data,
                                                std::span<const Eigen::Vector3d> data_mm,
                                                const RigidMotion& start_scan_from_cad,
                                                const RigidIcpOptions& options);

/// Point to plane against the CAD's own triangles, with the edges: scan points are carried back to the CAD;
/// their distance along the CAD normal, and the distance of the scan's edge points across the contour and
/// normal to it, are minimised by Gauss-Newton with annealed Geman-McClure weights. The surface counts as 100
/// points in all: the misfit of a deformed part is correlated, and with its full weight a twisted panel turns
/// the fit by degrees about its normal.
[[nodiscard]] RigidIcpResult icp_point_to_plane(const CadModel& cad, const ScanModel& scan,
                                                const RigidMotion& start_scan_from_cad,
                                                const RigidIcpOptions& options);
/// The same with other edge points than the scan's.
[[nodiscard]] RigidIcpResult icp_point_to_plane(const CadModel& cad, const ScanModel& scan,
                                                std::span<const Eigen::Vector3d> edge_mm,
                                                const RigidMotion& start_scan_from_cad,
                                                const RigidIcpOptions& options);

}  // namespace arris
