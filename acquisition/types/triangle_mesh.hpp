#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace arris {

/// Triangles over shared vertices, mm; counter-clockwise seen from the air side, so that normals leave the
/// material.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_mm;
  std::vector<std::array<std::int32_t, 3>> triangles;

  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

}  // namespace arris
