#include "acquisition/smooth_regions.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace arris {
namespace {

constexpr double kFlatTriangle = 1e-6;  // height over longest side, of a triangle without a normal of its own

}  // namespace

Eigen::Vector3d double_area_mm2(const TriangleMesh& mesh, std::size_t t) {
  const auto& corner = mesh.triangles[t];
  const Eigen::Vector3d& a = mesh.vertices_mm[static_cast<std::size_t>(corner[0])];
  return (mesh.vertices_mm[static_cast<std::size_t>(corner[1])] - a)
      .cross(mesh.vertices_mm[static_cast<std::size_t>(corner[2])] - a);
}

double side_mm(const TriangleMesh& mesh, std::size_t t, std::size_t side) {
  const auto& corner = mesh.triangles[t];
  return (mesh.vertices_mm[static_cast<std::size_t>(corner[(side + 1) % 3])] -
          mesh.vertices_mm[static_cast<std::size_t>(corner[side])])
      .norm();
}

std::size_t longest_side(const TriangleMesh& mesh, std::size_t t) {
  std::size_t longest = 0;
  for (const std::size_t side : {1, 2})
    if (side_mm(mesh, t, side) > side_mm(mesh, t, longest)) longest = side;
  return longest;
}

std::vector<Eigen::Vector3d> face_normals(const TriangleMesh& mesh, const MeshAdjacency& neighbours) {
  std::vector<Eigen::Vector3d> normals;
  std::vector<std::size_t> flat;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3d area_mm2 = double_area_mm2(mesh, t);
    const double longest_mm = side_mm(mesh, t, longest_side(mesh, t));
    const bool is_flat = !(area_mm2.norm() > kFlatTriangle * longest_mm * longest_mm);
    normals.push_back(is_flat ? Eigen::Vector3d::Zero() : Eigen::Vector3d(area_mm2.normalized()));
    if (is_flat) flat.push_back(t);
  }
  for (std::size_t before = flat.size() + 1; !flat.empty() && flat.size() < before;) {
    before = flat.size();
    std::erase_if(flat, [&](std::size_t t) {
      const std::int32_t other = neighbours.across[t][longest_side(mesh, t)];
      if (other >= 0) normals[t] = normals[static_cast<std::size_t>(other)];
      return !normals[t].isZero();
    });
  }
  return normals;
}

SmoothRegions smooth_regions(const TriangleMesh& mesh, const MeshAdjacency& neighbours,
                             const std::vector<Eigen::Vector3d>& normals, double sharp_edge_rad) {
  const double sharp_cos = std::cos(sharp_edge_rad);
  SmoothRegions regions;
  regions.of.assign(mesh.triangles.size(), -1);
  std::vector<std::int32_t> stack;
  for (std::size_t seed = 0; seed < regions.of.size(); ++seed) {
    if (regions.of[seed] >= 0) continue;
    const int region = static_cast<int>(regions.area_mm2.size());
    double area_mm2 = 0.0;
    Eigen::Vector3d sum_mm2 = Eigen::Vector3d::Zero();
    regions.of[seed] = region;
    stack.push_back(static_cast<std::int32_t>(seed));
    while (!stack.empty()) {
      const auto t = static_cast<std::size_t>(stack.back());
      stack.pop_back();
      const Eigen::Vector3d half_mm2 = 0.5 * double_area_mm2(mesh, t);
      area_mm2 += half_mm2.norm();
      sum_mm2 += half_mm2;
      for (const std::int32_t next : neighbours.across[t]) {
        if (next < 0 || regions.of[static_cast<std::size_t>(next)] >= 0) continue;
        if (normals[t].dot(normals[static_cast<std::size_t>(next)]) < sharp_cos) continue;
        regions.of[static_cast<std::size_t>(next)] = region;
        stack.push_back(next);
      }
    }
    regions.area_mm2.push_back(area_mm2);
    regions.mean_normal.push_back(area_mm2 > 0.0 ? Eigen::Vector3d(sum_mm2 / area_mm2) : sum_mm2);
  }
  return regions;
}

}  // namespace arris
