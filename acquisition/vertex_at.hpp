#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>

#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// The vertex of a mesh that lies exactly at a point: contours of a mesh are made of its vertices. Vertices
/// that coincide count as the first. Build O(n log n), query O(log n).
class VertexAt {
 public:
  explicit VertexAt(const TriangleMesh& mesh);
  /// Throws Error(kBug) where there is none.
  [[nodiscard]] std::size_t operator()(const Eigen::Vector3d& p_mm) const;

 private:
  std::map<std::array<double, 3>, std::size_t> number_;
};

}  // namespace arris
