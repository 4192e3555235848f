#include "acquisition/geometry/mesh_normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr std::size_t kChunk = 4096;
constexpr double kFlatRatio = 1e-12;  // height over longest edge, below which a triangle has no direction

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

void check_indices(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.vertices_mm.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::int32_t v : mesh.triangles[t])
      if (v < 0 || v >= count)
        throw Error(Fault::kBug, "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                                     " of " + std::to_string(count));
}

/// Side k of a triangle, by its ends.
struct Side {
  std::int32_t low, high, triangle, k;
};

/// By low, high, triangle, k. The low end by counting: a vertex has few sides, and these are then sorted.
std::vector<Side> sorted_sides(const TriangleMesh& mesh, int threads) {
  std::vector<std::size_t> first(mesh.vertices_mm.size() + 1, 0);
  const auto each_side = [&](const auto& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::int32_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(mesh.triangles[t][at(k)], mesh.triangles[t][at((k + 1) % 3)]);
        visit(Side{low, high, static_cast<std::int32_t>(t), k});
      }
  };
  each_side([&](const Side& side) { ++first[at(side.low) + 1]; });
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Side> sides(3 * mesh.triangles.size());
  std::vector<std::size_t> next = first;
  each_side([&](const Side& side) { sides[next[at(side.low)]++] = side; });
  parallel_for(mesh.vertices_mm.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      std::sort(sides.begin() + static_cast<std::ptrdiff_t>(first[v]),
                sides.begin() + static_cast<std::ptrdiff_t>(first[v + 1]), [](const Side& a, const Side& b) {
                  if (a.high != b.high) return a.high < b.high;
                  return a.triangle != b.triangle ? a.triangle < b.triangle : a.k < b.k;
                });
  });
  return sides;
}

void number_edges(const TriangleMesh& mesh, int threads, MeshNormals& normals) {
  const std::vector<Side> sides = sorted_sides(mesh, threads);
  normals.edge_of.resize(mesh.triangles.size());
  normals.vertex_is_border.assign(mesh.vertices_mm.size(), 0);
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t last = first;
    const auto id = static_cast<std::int32_t>(normals.edge_is_border.size());
    for (;
         last < sides.size() && sides[last].low == sides[first].low && sides[last].high == sides[first].high;
         ++last)
      normals.edge_of[at(sides[last].triangle)][at(sides[last].k)] = id;
    const bool border = last - first == 1;
    normals.edge_is_border.push_back(border ? 1 : 0);
    if (border)
      normals.vertex_is_border[at(sides[first].low)] = normals.vertex_is_border[at(sides[first].high)] = 1;
    first = last;
  }
}

std::vector<Eigen::Vector3d> sums_at_edges(const MeshNormals& normals) {
  std::vector<Eigen::Vector3d> sums(normals.edge_is_border.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < normals.face.size(); ++t)
    for (const std::int32_t edge : normals.edge_of[t]) sums[at(edge)] += normals.face[t];
  return sums;
}

// A triangle without area hides a T-junction: the faces beyond it meet at its edges. With their mean as its
// normal the pseudo-normals there still see both sides. A few rounds reach through strips of such triangles.
void fill_flat_faces(MeshNormals& normals) {
  if (std::find(normals.degenerate.begin(), normals.degenerate.end(), 1) == normals.degenerate.end()) return;
  for (int round = 0; round < 4; ++round) {
    const std::vector<Eigen::Vector3d> sums = sums_at_edges(normals);
    std::vector<Eigen::Vector3d> next = normals.face;
    for (std::size_t t = 0; t < normals.face.size(); ++t) {
      if (normals.degenerate[t] == 0) continue;
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const std::int32_t edge : normals.edge_of[t]) mean += sums[at(edge)] - normals.face[t];
      if (mean.norm() > 1e-9) next[t] = mean.normalized();
    }
    normals.face = std::move(next);
  }
}

/// At each corner of a triangle. To single precision, so that the last bit of atan2, which depends on the
/// CPU's instructions, does not matter.
std::array<float, 3> angles_of(const TriangleMesh& mesh, std::size_t t, bool has_area) {
  std::array<Eigen::Vector3d, 3> side_mm;  // from corner k to corner k + 1
  for (std::size_t k = 0; k < 3; ++k)
    side_mm[k] =
        mesh.vertices_mm[at(mesh.triangles[t][(k + 1) % 3])] - mesh.vertices_mm[at(mesh.triangles[t][k])];
  const double area2_mm2 = side_mm[0].cross(side_mm[1]).norm();
  std::array<double, 3> angles_rad{};
  for (std::size_t k = 0; k < 3; ++k)
    angles_rad[k] = k == 2 && has_area ? std::numbers::pi - angles_rad[0] - angles_rad[1]
                                       : std::atan2(area2_mm2, -side_mm[k].dot(side_mm[(k + 2) % 3]));
  std::array<float, 3> angles{};
  std::transform(angles_rad.begin(), angles_rad.end(), angles.begin(),
                 [](double rad) { return static_cast<float>(rad); });
  return angles;
}

void vertex_normals(const TriangleMesh& mesh, int threads, MeshNormals& normals) {
  std::vector<std::array<float, 3>> angles(mesh.triangles.size());
  parallel_for(angles.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) angles[t] = angles_of(mesh, t, normals.degenerate[t] == 0);
  });
  normals.vertex.assign(mesh.vertices_mm.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      normals.vertex[at(mesh.triangles[t][k])] += static_cast<double>(angles[t][k]) * normals.face[t];
}

void normalise(std::vector<Eigen::Vector3d>& vectors, int threads) {
  parallel_for(vectors.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double length = vectors[i].norm();
      if (length > 1e-12) vectors[i] /= length;
    }
  });
}

}  // namespace

MeshNormals face_normals(const TriangleMesh& mesh, int threads) {
  check_indices(mesh);
  MeshNormals normals;
  normals.degenerate.resize(mesh.triangles.size());
  normals.face.resize(mesh.triangles.size());
  parallel_for(mesh.triangles.size(), kChunk, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Eigen::Vector3d ab_mm = mesh.vertices_mm[at(b)] - mesh.vertices_mm[at(a)];
      const Eigen::Vector3d ac_mm = mesh.vertices_mm[at(c)] - mesh.vertices_mm[at(a)];
      const Eigen::Vector3d cross_mm2 = ab_mm.cross(ac_mm);
      const double longest_mm2 =
          std::max({ab_mm.squaredNorm(), ac_mm.squaredNorm(), (ac_mm - ab_mm).squaredNorm()});
      const bool flat = !(cross_mm2.norm() > kFlatRatio * longest_mm2);
      normals.degenerate[t] = flat ? 1 : 0;
      normals.face[t] = flat ? Eigen::Vector3d::Zero() : cross_mm2.normalized();
    }
  });
  return normals;
}

void add_edge_and_vertex_normals(const TriangleMesh& mesh, int threads, MeshNormals& normals) {
  number_edges(mesh, threads, normals);
  fill_flat_faces(normals);
  normals.edge = sums_at_edges(normals);
  vertex_normals(mesh, threads, normals);
  normalise(normals.edge, threads);
  normalise(normals.vertex, threads);
}

MeshNormals mesh_normals(const TriangleMesh& mesh, int threads) {
  MeshNormals normals = face_normals(mesh, threads);
  add_edge_and_vertex_normals(mesh, threads, normals);
  return normals;
}

}  // namespace arris
