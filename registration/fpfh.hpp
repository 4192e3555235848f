#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace arris {

/// How the normals round a point turn: three histograms of 11 bins, each summing to 1 (none near: all zero).
/// Does not change when points and normals move together.
using Fpfh = std::array<float, 33>;

/// Fast point feature histograms (Rusu, Blodow and Beetz, ICRA 2009) of oriented points: those of the pairs
/// within radius_mm, and those of the neighbours weighted by one over their distance.
/// Cost O(N * neighbours); the same bytes for any number of threads.
[[nodiscard]] std::vector<Fpfh> fpfh_of(std::span<const Eigen::Vector3d> points_mm,
                                        std::span<const Eigen::Vector3d> normals, double radius_mm,
                                        int threads);

/// Squared distance of two histograms.
[[nodiscard]] float distance2(const Fpfh& a, const Fpfh& b);

}  // namespace arris
