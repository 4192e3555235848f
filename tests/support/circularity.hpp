#pragma once

#include <Eigen/Core>
#include <span>

namespace arris::bench {

/// The circularity of a profile by ISO 1101 (minimum zone, ISO 12181): of all pairs of concentric circles
/// that hold the profile between them, the pair with the least difference of radii.
struct MinimumZone {
  Eigen::Vector2d centre_mm = Eigen::Vector2d::Zero();
  double inner_mm = 0.0, outer_mm = 0.0;  ///< radii
  [[nodiscard]] double width_mm() const { return outer_mm - inner_mm; }
};

/// For a profile that goes round its middle, in any order. The optimum touches the circles outside, inside,
/// outside, inside in turn (four points); it is found by Remez exchange on r = a + b cos t + c sin t about a
/// centre that is moved until b and c vanish, so the result is exact, not a sampled search. Throws
/// Error(kBug) below four points, or where no such four exist (the profile does not go round).
[[nodiscard]] MinimumZone minimum_zone(std::span<const Eigen::Vector2d> profile_mm);

/// The same of points in space, projected on their plane of least squares.
[[nodiscard]] MinimumZone circularity(std::span<const Eigen::Vector3d> profile_mm);

}  // namespace arris::bench
