#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "acquisition/types/frames.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris::testing {

/// Box about the origin, twelve triangles, outward.
inline TriangleMesh box_mesh(const Eigen::Vector3d& half_mm) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.emplace_back(i & 1 ? half_mm.x() : -half_mm.x(), i & 2 ? half_mm.y() : -half_mm.y(),
                                  i & 4 ? half_mm.z() : -half_mm.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Signed distance to that box, in closed form.
inline double box_signed_mm(const Eigen::Vector3d& half_mm, const Eigen::Vector3d& p_mm) {
  const Eigen::Vector3d beyond_mm = p_mm.cwiseAbs() - half_mm;
  return beyond_mm.cwiseMax(0.0).norm() + std::min(beyond_mm.maxCoeff(), 0.0);
}

/// Octahedron split `rounds` times onto a sphere about the origin.
inline TriangleMesh sphere_mesh(double radius_mm, int rounds) {
  TriangleMesh mesh;
  for (const int axis : {0, 1, 2})
    for (const double side : {1.0, -1.0})
      mesh.vertices_mm.push_back(side * radius_mm * Eigen::Vector3d::Unit(axis));
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<int, int>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), 0);
      if (fresh) {
        const auto sum_mm =
            (mesh.vertices_mm[static_cast<std::size_t>(a)] + mesh.vertices_mm[static_cast<std::size_t>(b)])
                .eval();
        entry->second = static_cast<std::int32_t>(mesh.vertices_mm.size());
        mesh.vertices_mm.push_back(radius_mm * sum_mm.normalized());
      }
      return entry->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// Flat square sheet in z = 0 about the origin, cells x cells squares of two triangles, air on +z.
inline TriangleMesh sheet_mesh(double half_mm, int cells) {
  TriangleMesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh.vertices_mm.emplace_back(half_mm * (2.0 * i / cells - 1.0), half_mm * (2.0 * j / cells - 1.0),
                                    0.0);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const std::int32_t a = j * (cells + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + cells + 2});
      mesh.triangles.push_back({a, a + cells + 2, a + cells + 1});
    }
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const RigidMotion& motion) {
  for (Eigen::Vector3d& v_mm : mesh.vertices_mm) v_mm = motion * v_mm;
  return mesh;
}

}  // namespace arris::testing
