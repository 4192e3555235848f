#pragma once

#include <optional>

#include "registration/sphere_finder.hpp"

namespace arris {

/// Least squares centre of a sphere of known radius through those `candidates` that lie within four robust
/// standard deviations of it, begun at `start_mm` with a tenth of the radius. Nothing when they are no sphere
/// (see SphereFinder::find).
///   candidates   numbers of the points round the start
[[nodiscard]] std::optional<FoundSphere> fit_sphere(std::span<const Eigen::Vector3d> points_mm,
                                                    const std::vector<std::int32_t>& candidates,
                                                    const Eigen::Vector3d& start_mm, double radius_mm,
                                                    const SphereOptions& options);

/// Smallest eigenvalue of the mean of u u^T over unit directions: how well a sphere seen in these directions
/// fixes its centre. 1/3: seen all round; a cap of half-angle t: (2 - cos t - cos^2 t) / 6; 0: a great
/// circle.
[[nodiscard]] double least_spread(const Eigen::Matrix3d& sum_of_squares, std::size_t count);

}  // namespace arris
