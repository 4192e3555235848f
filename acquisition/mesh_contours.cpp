#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "acquisition/contour_extract.hpp"
#include "acquisition/contour_set.hpp"
#include "acquisition/mesh_borders.hpp"
#include "acquisition/smooth_regions.hpp"

namespace arris {
namespace {

constexpr BendWindow kDrawnBend{.chords = 3.0, .exact_corners = true};
constexpr BendWindow kScannedBend{.chords = 3.0, .exact_corners = false};
constexpr double kCrackWidth = 1e-4;  // mean width over length, of a loop that is a crack

std::int32_t start_vertex(const TriangleMesh& mesh, const BorderEdge& edge) {
  return mesh.triangles[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.side)];
}

/// A mesh with what every search for contours needs.
struct Borders {
  const TriangleMesh& mesh;
  MeshAdjacency neighbours;
  std::vector<Eigen::Vector3d> normals;
  std::size_t cracks = 0;  // loops left out

  explicit Borders(const TriangleMesh& of)
      : mesh(of), neighbours(adjacency(of)), normals(face_normals(of, neighbours)) {}
};

/// A loop's points, each with the mean normal of the faces of the two border edges that meet there.
FoundContour contour_of(const Borders& borders, const std::vector<BorderEdge>& loop,
                        const std::string& source) {
  FoundContour found;
  found.contour.closed = true;
  found.contour.source = source;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const BorderEdge& before = loop[(i + loop.size() - 1) % loop.size()];
    found.contour.points_mm.push_back(
        borders.mesh.vertices_mm[static_cast<std::size_t>(start_vertex(borders.mesh, loop[i]))]);
    found.contour.normals.push_back((borders.normals[static_cast<std::size_t>(loop[i].triangle)] +
                                     borders.normals[static_cast<std::size_t>(before.triangle)])
                                        .normalized());
  }
  return found;
}

/// Whether the loop has no width: faces that do not share their corners (a T-junction) leave such.
bool is_crack(const TriangleMesh& mesh, const std::vector<BorderEdge>& loop) {
  Eigen::Vector3d mean_mm = Eigen::Vector3d::Zero();
  for (const BorderEdge& edge : loop)
    mean_mm += mesh.vertices_mm[static_cast<std::size_t>(start_vertex(mesh, edge))] /
               static_cast<double>(loop.size());
  double area_mm2 = 0.0, length_mm = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto& a_mm = mesh.vertices_mm[static_cast<std::size_t>(start_vertex(mesh, loop[i]))];
    const auto& b_mm =
        mesh.vertices_mm[static_cast<std::size_t>(start_vertex(mesh, loop[(i + 1) % loop.size()]))];
    area_mm2 += 0.5 * (a_mm - mean_mm).cross(b_mm - mean_mm).norm();
    length_mm += (b_mm - a_mm).norm();
  }
  return 2.0 * area_mm2 <= kCrackWidth * length_mm * length_mm;
}

/// Loops of one-face edges. Crowded edges end faces as well, but a loop of nothing else is left out.
std::vector<std::vector<BorderEdge>> open_loops(Borders& borders) {
  auto loops = border_loops(borders.mesh, borders.neighbours,
                            [&](std::int32_t t, int k) { return borders.neighbours.at(t, k) < 0; });
  std::erase_if(loops, [&](const auto& loop) {
    return std::none_of(loop.begin(), loop.end(), [&](const BorderEdge& edge) {
      return borders.neighbours.at(edge.triangle, edge.side) == MeshAdjacency::kNone;
    });
  });
  borders.cracks += std::erase_if(loops, [&](const auto& loop) { return is_crack(borders.mesh, loop); });
  return loops;
}

/// Mean cosine between the faces along a loop and the plane that it encloses: 1 beside a flat face whose rim
/// it is, 0 beside the wall of a hole. Weighted by edge length.
double facing_ratio(const Borders& borders, const std::vector<BorderEdge>& loop) {
  const auto start_mm = [&](std::size_t i) -> const Eigen::Vector3d& {
    return borders.mesh
        .vertices_mm[static_cast<std::size_t>(start_vertex(borders.mesh, loop[i % loop.size()]))];
  };
  Eigen::Vector3d enclosed_mm2 = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i)
    enclosed_mm2 += (start_mm(i) - start_mm(0)).cross(start_mm(i + 1) - start_mm(0));
  enclosed_mm2.normalize();
  double sum_mm = 0.0, length_mm = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double edge_mm = (start_mm(i + 1) - start_mm(i)).norm();
    const Eigen::Vector3d& normal = borders.normals[static_cast<std::size_t>(loop[i].triangle)];
    sum_mm += edge_mm * std::abs(normal.dot(enclosed_mm2));
    length_mm += edge_mm;
  }
  return length_mm > 0.0 ? sum_mm / length_mm : 0.0;
}

/// Of two regions that share a whole loop: whether the first one keeps it, by facing_ratio(), then by area.
struct LoopOfRegion {
  double facing_ratio = -1.0, area_mm2 = 0.0;
  std::vector<BorderEdge> loop;

  [[nodiscard]] bool keeps_before(const LoopOfRegion& other) const {
    constexpr double kAlike = 0.05;
    if (std::abs(facing_ratio - other.facing_ratio) > kAlike) return facing_ratio > other.facing_ratio;
    return area_mm2 > other.area_mm2;
  }
};

std::vector<FoundContour> sharp_contours(const Borders& borders, double sharp_edge_rad) {
  const SmoothRegions regions =
      smooth_regions(borders.mesh, borders.neighbours, borders.normals, sharp_edge_rad);
  const auto region_of = [&](std::int32_t t) { return regions.of[static_cast<std::size_t>(t)]; };
  const auto is_border = [&](std::int32_t t, int k) {
    const std::int32_t other = borders.neighbours.at(t, k);
    return other < 0 || region_of(t) != region_of(other);
  };
  std::map<std::vector<std::int32_t>, LoopOfRegion> kept;
  for (auto& loop : border_loops(borders.mesh, borders.neighbours, is_border)) {
    if (is_crack(borders.mesh, loop)) continue;
    std::vector<std::int32_t> vertices;
    for (const BorderEdge& edge : loop) vertices.push_back(start_vertex(borders.mesh, edge));
    std::sort(vertices.begin(), vertices.end());
    const double area_mm2 = regions.area_mm2[static_cast<std::size_t>(region_of(loop.front().triangle))];
    LoopOfRegion candidate{facing_ratio(borders, loop), area_mm2, std::move(loop)};
    LoopOfRegion& entry = kept[std::move(vertices)];
    if (candidate.keeps_before(entry)) entry = std::move(candidate);
  }
  std::vector<FoundContour> contours;
  for (const auto& [vertices, entry] : kept)
    contours.push_back(contour_of(borders, entry.loop, "sharp edge"));
  return contours;
}

void note_oddities(const Borders& borders, ContourSet& set) {
  if (borders.neighbours.crowded_edges > 0)
    set.notes.push_back(std::to_string(borders.neighbours.crowded_edges) +
                        " edges have more than two faces, or two that wind alike; they are no contours");
  if (borders.cracks > 0)
    set.notes.push_back(std::to_string(borders.cracks) +
                        " cracks between faces that do not share their corners are no contours");
}

double median_edge_mm(const TriangleMesh& mesh) {
  std::vector<double> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(side_mm(mesh, t, k));
  if (edges.empty()) return 0.0;
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::nth_element(edges.begin(), middle, edges.end());
  return *middle;
}

}  // namespace

ContourSet mesh_contours(const TriangleMesh& mesh, const ContourOptions& options) {
  Borders borders(mesh);
  std::vector<FoundContour> contours;
  for (const auto& loop : open_loops(borders)) contours.push_back(contour_of(borders, loop, "boundary"));
  if (contours.empty()) contours = sharp_contours(borders, options.sharp_edge_rad);
  ContourSet set = measured(std::move(contours), options.min_length_mm, kDrawnBend);
  note_oddities(borders, set);
  return set;
}

ContourSet scan_mesh_contours(const Scan& scan, const ContourOptions& options) {
  TriangleMesh mesh;
  mesh.vertices_mm = local_points_mm(scan.cloud);
  mesh.triangles = scan.triangles;
  const double median_mm = median_edge_mm(mesh);
  TriangleMesh trimmed;
  trimmed.vertices_mm = mesh.vertices_mm;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (side_mm(mesh, t, longest_side(mesh, t)) <= options.outsized_edge_ratio * median_mm)
      trimmed.triangles.push_back(mesh.triangles[t]);
  const std::size_t outsized = mesh.triangles.size() - trimmed.triangles.size();
  if (trimmed.triangles.size() < mesh.triangles.size() / 2)
    return mesh_contours(mesh, options);  // a coarse mesh
  Borders whole(mesh), borders(trimmed);
  std::vector<char> was_border(mesh.vertices_mm.size(), 0);
  for (const auto& loop : open_loops(whole))
    for (const BorderEdge& edge : loop) was_border[static_cast<std::size_t>(start_vertex(mesh, edge))] = 1;
  std::vector<FoundContour> contours;
  for (const auto& loop : open_loops(borders)) {
    contours.push_back(contour_of(borders, loop, "boundary"));
    const auto old = std::count_if(loop.begin(), loop.end(), [&](const BorderEdge& edge) {
      return was_border[static_cast<std::size_t>(start_vertex(trimmed, edge))] != 0;
    });
    if (2 * static_cast<std::size_t>(old) < loop.size())
      contours.back().note = "filled hole: the scanner's software stretched triangles over it";
  }
  const double shortest_mm = options.min_length_mm > 0.0 ? options.min_length_mm : 10.0 * median_mm;
  ContourSet set = measured(std::move(contours), shortest_mm, kScannedBend);
  if (outsized > 0)
    set.notes.push_back(std::to_string(outsized) +
                        " outsized triangles fill holes of the scan and are left out");
  note_oddities(borders, set);
  return set;
}

}  // namespace arris
