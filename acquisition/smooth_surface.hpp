#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/geometry/nearest.hpp"
#include "acquisition/geometry/normals.hpp"

namespace arris {

/// The nearest others of every point, nearest first.
struct NeighbourTable {
  static constexpr std::size_t kCount = 12;
  std::vector<std::int32_t> index;  ///< kCount a point; -1 where a small cloud has no more

  [[nodiscard]] std::span<const std::int32_t> of(std::size_t point) const {
    return {index.data() + point * kCount, kCount};
  }
};

[[nodiscard]] NeighbourTable neighbour_table(std::span<const Eigen::Vector3d> points_mm,
                                             const NearestPoints& tree, int threads);

/// The part of a cloud that is smooth surface.
struct SmoothSurface {
  std::vector<Eigen::Vector3d>
      normals;           ///< a point's own, or near an edge those of the flat points beside it
  std::vector<char> on;  ///< 0: a stray, or on the wall of a cut
};

/// A point is flat when nearly all its neighbours lie in its plane. What is near an edge is not: there, a
/// plane fitted to points of the face and of the wall of the cut shows neither. Such a point is on the
/// surface when it lies in the planes of flat neighbours, which are carried outwards to the edge a few
/// neighbours deep. Gate: 4 sigma of the noise, at least 0.06 spacings. Cost O(N); the same for any thread
/// count.
[[nodiscard]] SmoothSurface smooth_surface(std::span<const Eigen::Vector3d> points_mm,
                                           const NeighbourTable& table, const LocalPlanes& planes,
                                           int threads);

}  // namespace arris
