#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "acquisition/contour_extract.hpp"
#include "acquisition/contour_set.hpp"
#include "acquisition/mesh_borders.hpp"

namespace arris {
namespace {

Eigen::Vector3d area_vector(const TriangleMesh& mesh, std::size_t t) {
  const auto& corner = mesh.triangles[t];
  const Eigen::Vector3d& a = mesh.vertices_mm[static_cast<std::size_t>(corner[0])];
  return (mesh.vertices_mm[static_cast<std::size_t>(corner[1])] - a)
      .cross(mesh.vertices_mm[static_cast<std::size_t>(corner[2])] - a);
}

std::int32_t start_vertex(const TriangleMesh& mesh, const BorderEdge& edge) {
  return mesh.triangles[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.side)];
}

/// A loop's points, each with the mean normal of the faces of the two border edges that meet there.
FoundContour contour_of(const TriangleMesh& mesh, const std::vector<BorderEdge>& loop, const std::string& source) {
  FoundContour found;
  found.contour.closed = true;
  found.contour.source = source;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const BorderEdge& before = loop[(i + loop.size() - 1) % loop.size()];
    found.contour.points_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(start_vertex(mesh, loop[i]))]);
    const Eigen::Vector3d normal = area_vector(mesh, static_cast<std::size_t>(loop[i].triangle)).normalized() +
                                   area_vector(mesh, static_cast<std::size_t>(before.triangle)).normalized();
    found.contour.normals.push_back(normal.normalized());
  }
  return found;
}

bool is_sharp(const TriangleMesh& mesh, std::int32_t a, std::int32_t b, double sharp_edge_rad) {
  const Eigen::Vector3d na = area_vector(mesh, static_cast<std::size_t>(a)).normalized();
  const Eigen::Vector3d nb = area_vector(mesh, static_cast<std::size_t>(b)).normalized();
  return na.dot(nb) < std::cos(sharp_edge_rad);
}

/// Smooth regions: triangles joined across every side that is not sharp.
struct Regions {
  std::vector<int> of;          // region of each triangle
  std::vector<double> area_mm2;
};

Regions smooth_regions(const TriangleMesh& mesh, const MeshAdjacency& neighbours, double sharp_edge_rad) {
  Regions regions;
  regions.of.assign(mesh.triangles.size(), -1);
  std::vector<std::int32_t> stack;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (regions.of[seed] >= 0) continue;
    const int region = static_cast<int>(regions.area_mm2.size());
    regions.area_mm2.push_back(0.0);
    regions.of[seed] = region;
    stack.push_back(static_cast<std::int32_t>(seed));
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      regions.area_mm2.back() += 0.5 * area_vector(mesh, static_cast<std::size_t>(t)).norm();
      for (const std::int32_t next : neighbours.across[static_cast<std::size_t>(t)]) {
        if (next < 0 || regions.of[static_cast<std::size_t>(next)] >= 0) continue;
        if (is_sharp(mesh, t, next, sharp_edge_rad)) continue;
        regions.of[static_cast<std::size_t>(next)] = region;
        stack.push_back(next);
      }
    }
  }
  return regions;
}

std::vector<std::vector<BorderEdge>> open_loops(const TriangleMesh& mesh, const MeshAdjacency& neighbours) {
  return border_loops(mesh, neighbours, [&](std::int32_t t, int k) {
    return neighbours.across[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)] < 0;
  });
}

std::vector<FoundContour> open_contours(const TriangleMesh& mesh, const MeshAdjacency& neighbours) {
  std::vector<FoundContour> contours;
  for (const auto& loop : open_loops(mesh, neighbours)) contours.push_back(contour_of(mesh, loop, "boundary"));
  return contours;
}

std::vector<FoundContour> sharp_contours(const TriangleMesh& mesh, const MeshAdjacency& neighbours,
                                         double sharp_edge_rad) {
  const Regions regions = smooth_regions(mesh, neighbours, sharp_edge_rad);
  const auto is_border = [&](std::int32_t t, int k) {
    const std::int32_t other = neighbours.across[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
    return other < 0 || is_sharp(mesh, t, other, sharp_edge_rad);
  };
  // Two regions that share a whole loop: the larger one keeps it.
  std::map<std::vector<std::int32_t>, std::pair<double, std::vector<BorderEdge>>> kept;
  for (auto& loop : border_loops(mesh, neighbours, is_border)) {
    std::vector<std::int32_t> vertices;
    for (const BorderEdge& edge : loop) vertices.push_back(start_vertex(mesh, edge));
    std::sort(vertices.begin(), vertices.end());
    const double area_mm2 =
        regions.area_mm2[static_cast<std::size_t>(regions.of[static_cast<std::size_t>(loop.front().triangle)])];
    auto& entry = kept[std::move(vertices)];
    if (area_mm2 > entry.first) entry = {area_mm2, std::move(loop)};
  }
  std::vector<FoundContour> contours;
  for (const auto& [vertices, entry] : kept) contours.push_back(contour_of(mesh, entry.second, "sharp edge"));
  return contours;
}

double median_edge_mm(const TriangleMesh& mesh) {
  std::vector<double> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back((mesh.vertices_mm[static_cast<std::size_t>(t[k])] -
                       mesh.vertices_mm[static_cast<std::size_t>(t[(k + 1) % 3])]).norm());
  if (edges.empty()) return 0.0;
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::nth_element(edges.begin(), middle, edges.end());
  return *middle;
}

bool is_outsized(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t, double longest_mm) {
  for (std::size_t k = 0; k < 3; ++k)
    if ((mesh.vertices_mm[static_cast<std::size_t>(t[k])] - mesh.vertices_mm[static_cast<std::size_t>(t[(k + 1) % 3])])
            .norm() > longest_mm)
      return true;
  return false;
}

}  // namespace

ContourSet mesh_contours(const TriangleMesh& mesh, const ContourOptions& options) {
  const MeshAdjacency neighbours = adjacency(mesh);
  std::vector<FoundContour> loops = open_contours(mesh, neighbours);
  if (loops.empty()) loops = sharp_contours(mesh, neighbours, options.sharp_edge_rad);
  ContourSet set = measured(std::move(loops), options.min_length_mm);
  if (neighbours.crowded_edges > 0)
    set.notes.push_back(std::to_string(neighbours.crowded_edges) +
                        " edges have more than two faces, or two that wind alike; they count as borders");
  return set;
}

ContourSet scan_mesh_contours(const Scan& scan, const ContourOptions& options) {
  TriangleMesh mesh;
  mesh.vertices_mm = local_points_mm(scan.cloud);
  mesh.triangles = scan.triangles;
  const double longest_mm = options.outsized_edge_ratio * median_edge_mm(mesh);
  TriangleMesh trimmed = mesh;
  std::erase_if(trimmed.triangles, [&](const auto& t) { return is_outsized(mesh, t, longest_mm); });
  const std::size_t outsized = mesh.triangles.size() - trimmed.triangles.size();
  if (trimmed.triangles.size() < mesh.triangles.size() / 2) return mesh_contours(mesh, options);  // a coarse mesh
  std::vector<char> was_border(mesh.vertices_mm.size(), 0);
  for (const auto& loop : open_loops(mesh, adjacency(mesh)))
    for (const BorderEdge& edge : loop) was_border[static_cast<std::size_t>(start_vertex(mesh, edge))] = 1;
  std::vector<FoundContour> contours;
  for (const auto& loop : open_loops(trimmed, adjacency(trimmed))) {
    contours.push_back(contour_of(trimmed, loop, "boundary"));
    const auto old = std::count_if(loop.begin(), loop.end(), [&](const BorderEdge& edge) {
      return was_border[static_cast<std::size_t>(start_vertex(trimmed, edge))] != 0;
    });
    if (2 * static_cast<std::size_t>(old) < loop.size())
      contours.back().note = "filled hole: the scanner's software stretched triangles over it";
  }
  const double shortest_mm = options.min_length_mm > 0.0 ? options.min_length_mm : 10.0 * median_edge_mm(mesh);
  ContourSet set = measured(std::move(contours), shortest_mm);
  if (outsized > 0)
    set.notes.push_back(std::to_string(outsized) + " outsized triangles fill holes of the scan and are left out");
  return set;
}

}  // namespace arris
