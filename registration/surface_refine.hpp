#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "acquisition/types/frames.hpp"
#include "registration/scene.hpp"
#include "registration/seen_elsewhere.hpp"
#include "registration/surface_basis.hpp"
#include "registration/surface_options.hpp"

namespace arris {

/// The deformation of the band: a CAD point x goes to scan_from_cad * (x + u(x)), u from the nodes' shifts.
struct SurfaceFit {
  RigidMotion scan_from_cad = RigidMotion::Identity();
  std::shared_ptr<const SurfaceBasis> basis;
  std::vector<Eigen::Vector3d> shift_mm;  ///< one a node, CAD frame
  std::vector<double> offset_mm;          ///< one an edge used: it lies this far inside the material
  Eigen::MatrixXd covariance;             ///< of the node shifts (3 each), then the offsets; mm^2
  /// How far strains that all of the sheet may share would have moved the unknowns of the covariance, in
  /// columns that are independent; not in the covariance.
  Eigen::MatrixXd common_strain_mm;
  double scanner_sd_mm = 0.0;  ///< of the scanner's edge; not in the covariance
  /// Mean square of the height that neighbouring points share beyond the field (in the covariance), and how
  /// much more of it there is about each node.
  double unfollowed_mean_mm2 = 0.0;
  std::vector<double> unfollowed_mm2;
  SeenElsewhere elsewhere;
  double sigma_mm = 0.0;  ///< robust residual normal to the surface
  std::size_t pairs = 0;
  int rounds = 0;
  std::string stop;    ///< "converged", "round limit"
  std::string reason;  ///< why there is no result; empty when usable
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// Fits the surface field from a rigid start: scan points to the deformed CAD (point to plane), the edges by
/// one-sided support, little strain of the mid-surface and little change of curvature. Gauss-Newton with
/// annealed Geman-McClure weights, partners renewed every round.
///   refuses  a CAD band without room for six nodes; a fit that does not stay finite
///   cost     O(rounds * (points * 25^2 + nodes^3)); the same bytes for any number of threads
///   source   node blending after Sumner, Schmid, Pauly, ACM TOG 26(3), 2007; annealing after Yang et al.,
///            RA-L 5(2), 2020
[[nodiscard]] SurfaceFit refine_surface(const CadModel& cad, const ScanModel& scan,
                                        const RigidMotion& rigid_scan_from_cad,
                                        const SurfaceOptions& options);

}  // namespace arris
