#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "acquisition/types/frames.hpp"

namespace arris {

/// Outcome of a closed-form rigid fit; read the motion only if usable().
struct RigidFit {
  RigidMotion to_from = RigidMotion::Identity();
  double rms_mm = 0.0;  ///< weighted, over all pairs
  std::string reason;   ///< empty when usable
  [[nodiscard]] bool usable() const { return reason.empty(); }
};

/// Weighted least-squares rigid motion that carries `from` onto `to`, pair by pair; never a reflection.
///   from_mm, to_mm   N points, pair i with i; weights empty or N values >= 0
///   refuses   fewer than 3 pairs; points of either frame on a line (second principal spread below 1e-9 of
///             the first); several rotations that fit equally well
///   source    Horn, J. Opt. Soc. Am. A 4(4), 1987: unit quaternion of the largest eigenvalue (paper eq. 1)
[[nodiscard]] RigidFit fit_rigid(std::span<const Eigen::Vector3d> from_mm,
                                 std::span<const Eigen::Vector3d> to_mm,
                                 std::span<const double> weights = {});

}  // namespace arris
