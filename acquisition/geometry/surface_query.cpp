#include "acquisition/geometry/surface_query.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquisition/geometry/box_tree.hpp"
#include "acquisition/geometry/mesh_normals.hpp"

namespace arris {
namespace {

// A foot this near to an edge, in parts of the triangle's longest edge, is on it: the edge's normal decides
// the side.
constexpr double kOnEdgeRatio = 1e-9;

struct Foot {
  Eigen::Vector3d foot_mm;
  Eigen::Vector3d barycentric;
  double distance2_mm2;
};

Foot foot_at(const std::array<Eigen::Vector3d, 3>& corners_mm, const Eigen::Vector3d& barycentric,
             const Eigen::Vector3d& query_mm) {
  const Eigen::Vector3d foot_mm = corners_mm[0] + barycentric[1] * (corners_mm[1] - corners_mm[0]) +
                                  barycentric[2] * (corners_mm[2] - corners_mm[0]);
  return {foot_mm, barycentric, (query_mm - foot_mm).squaredNorm()};
}

// Nearest point of a triangle by its Voronoi regions (Ericson, Real-Time Collision Detection, 2005,
// section 5.1.5).
Foot nearest_on_triangle(const std::array<Eigen::Vector3d, 3>& corners_mm, const Eigen::Vector3d& query_mm) {
  const Eigen::Vector3d ab = corners_mm[1] - corners_mm[0];
  const Eigen::Vector3d ac = corners_mm[2] - corners_mm[0];
  const auto answer = [&](double b, double c) {
    return foot_at(corners_mm, Eigen::Vector3d(1.0 - b - c, b, c), query_mm);
  };
  const Eigen::Vector3d ap = query_mm - corners_mm[0];
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return answer(0.0, 0.0);
  const Eigen::Vector3d bp = query_mm - corners_mm[1];
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return answer(1.0, 0.0);
  const Eigen::Vector3d cp = query_mm - corners_mm[2];
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return answer(0.0, 1.0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return answer(d1 / (d1 - d3), 0.0);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return answer(0.0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return answer(1.0 - w, w);
  }
  const double total = va + vb + vc;
  const double b = std::clamp(vb / total, 0.0, 1.0);
  return answer(b, std::clamp(vc / total, 0.0, 1.0 - b));
}

}  // namespace

struct SurfaceQuery::Impl {
  explicit Impl(const TriangleMesh& mesh_) : mesh(mesh_), normals(mesh_normals(mesh_)) {
    std::vector<Eigen::AlignedBox3d> boxes_mm;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (normals.degenerate[t] != 0) continue;
      triangle_of.push_back(static_cast<std::int32_t>(t));
      boxes_mm.emplace_back();
      for (const Eigen::Vector3d& corner_mm : corners(t)) boxes_mm.back().extend(corner_mm);
    }
    tree = BoxTree(boxes_mm);
  }

  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::size_t t) const {
    const auto& [a, b, c] = mesh.triangles[t];
    return {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
            mesh.vertices_mm[static_cast<std::size_t>(c)]};
  }

  [[nodiscard]] SurfacePoint describe(std::size_t triangle, const Foot& foot,
                                      const Eigen::Vector3d& query_mm) const;

  TriangleMesh mesh;
  MeshNormals normals;
  std::vector<std::int32_t> triangle_of;  // mesh triangle of each triangle in the tree
  BoxTree tree;
};

SurfacePoint SurfaceQuery::Impl::describe(std::size_t triangle, const Foot& foot,
                                          const Eigen::Vector3d& query_mm) const {
  SurfacePoint answer;
  answer.triangle = static_cast<std::int32_t>(triangle);
  answer.foot_mm = foot.foot_mm;
  answer.barycentric = foot.barycentric;
  answer.distance_mm = std::sqrt(foot.distance2_mm2);
  answer.normal = normals.face[triangle];

  const std::array<Eigen::Vector3d, 3> p_mm = corners(triangle);
  const std::array<double, 3> edge_mm = {(p_mm[1] - p_mm[0]).norm(), (p_mm[2] - p_mm[1]).norm(),
                                         (p_mm[0] - p_mm[2]).norm()};
  const double tolerance_mm = kOnEdgeRatio * std::max({edge_mm[0], edge_mm[1], edge_mm[2]});
  const double area2_mm2 = (p_mm[1] - p_mm[0]).cross(p_mm[2] - p_mm[0]).norm();
  for (std::size_t k = 0; k < 3;
       ++k) {  // height of the foot over edge k: its share of the opposite corner's height
    if (foot.barycentric[static_cast<int>((k + 2) % 3)] * area2_mm2 > tolerance_mm * edge_mm[k]) continue;
    const auto edge = static_cast<std::size_t>(normals.edge_of[triangle][k]);
    answer.normal = normals.edge[edge];
    answer.on_border = answer.on_border || normals.edge_is_border[edge] != 0;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if ((foot.foot_mm - p_mm[k]).norm() > tolerance_mm) continue;
    const auto vertex = static_cast<std::size_t>(mesh.triangles[triangle][k]);
    answer.normal = normals.vertex[vertex];
    answer.on_border = normals.vertex_is_border[vertex] != 0;
  }
  if (answer.normal.squaredNorm() < 0.5)
    answer.normal = normals.face[triangle];  // faces folded onto each other
  const bool outside = answer.normal.dot(query_mm - foot.foot_mm) >= 0.0;
  answer.signed_mm = outside ? answer.distance_mm : -answer.distance_mm;
  return answer;
}

namespace {

/// The nearest triangle of those looked at so far.
struct Nearest {
  const TriangleMesh& mesh;
  const Eigen::Vector3d& query_mm;
  double limit2_mm2;
  std::int32_t triangle = -1;
  Foot foot{};

  void look_at(std::int32_t t) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(t)];
    const Foot candidate = nearest_on_triangle(
        {mesh.vertices_mm[static_cast<std::size_t>(a)], mesh.vertices_mm[static_cast<std::size_t>(b)],
         mesh.vertices_mm[static_cast<std::size_t>(c)]},
        query_mm);
    if (!(candidate.distance2_mm2 <= limit2_mm2)) return;
    if (candidate.distance2_mm2 == limit2_mm2 && triangle >= 0 && t > triangle) return;
    limit2_mm2 = candidate.distance2_mm2;
    triangle = t;
    foot = candidate;
  }
};

}  // namespace

SurfaceQuery::SurfaceQuery(const TriangleMesh& mesh) : impl_(std::make_shared<const Impl>(mesh)) {}

SurfacePoint SurfaceQuery::closest(const Eigen::Vector3d& query_mm, double max_distance_mm,
                                   std::int32_t hint) const {
  const Impl& impl = *impl_;
  if (!query_mm.allFinite() || !(max_distance_mm >= 0.0)) return {};
  Nearest nearest{impl.mesh, query_mm, max_distance_mm * max_distance_mm};
  if (hint >= 0) nearest.look_at(hint);
  impl.tree.search(query_mm, nearest.limit2_mm2, [&](std::int32_t item) {
    nearest.look_at(impl.triangle_of[static_cast<std::size_t>(item)]);
    return nearest.limit2_mm2;
  });
  if (nearest.triangle < 0) return {};
  return impl.describe(static_cast<std::size_t>(nearest.triangle), nearest.foot, query_mm);
}

}  // namespace arris
