#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "acquisition/contour_extract.hpp"
#include "acquisition/geometry/nearest.hpp"
#include "fixtures/synthetic/fe_part.hpp"

namespace arris {
namespace {

// The criterion of Dieulot, Rabate and Bearee (2010), section 2.1: a point whose number of neighbours, by the
// mean distance between points, differs from the number of triangles it belongs to lies on a contour.

std::vector<int> triangles_of(const TriangleMesh& mesh) {
  std::vector<int> count(mesh.vertices_mm.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const std::int32_t v : t) ++count[static_cast<std::size_t>(v)];
  return count;
}

std::vector<std::set<std::int32_t>> rings_of(const TriangleMesh& mesh) {
  std::vector<std::set<std::int32_t>> rings(mesh.vertices_mm.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      rings[static_cast<std::size_t>(t[k])].insert(t[(k + 1) % 3]);
      rings[static_cast<std::size_t>(t[k])].insert(t[(k + 2) % 3]);
    }
  return rings;
}

double mean_edge_mm(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sum += (mesh.vertices_mm[static_cast<std::size_t>(t[k])] -
              mesh.vertices_mm[static_cast<std::size_t>(t[(k + 1) % 3])])
                 .norm();
  return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

std::vector<char> on_a_contour(const TriangleMesh& mesh) {
  const NearestPoints tree(mesh.vertices_mm);
  std::vector<char> on(mesh.vertices_mm.size(), 0);
  for (const FoundContour& found : mesh_contours(mesh, {}).found)
    for (const Eigen::Vector3d& p_mm : found.contour.points_mm)
      on[static_cast<std::size_t>(tree.nearest(p_mm).index)] = 1;
  return on;
}

TEST(NeighbourCount, OverEdgesIsOneMoreThanTheTrianglesOnAContourAndEqualElsewhere) {
  for (const char* name : {"porthole", "nosecone", "sheet"}) {
    const auto part = synthetic::load_fe_part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe" / name);
    const TriangleMesh mesh = part.mesh(8.0, false);
    const auto triangles = triangles_of(mesh);
    const auto rings = rings_of(mesh);
    const auto on = on_a_contour(mesh);
    for (std::size_t v = 0; v < on.size(); ++v)
      ASSERT_EQ(static_cast<int>(rings[v].size()), triangles[v] + (on[v] ? 1 : 0)) << name;
  }
}

TEST(NeighbourCount, ByMeanDistanceAgreesOnAThirdOfARealMesh) {
  // Word for word: neighbours are the points within the mean distance. On meshes whose edges are not all
  // alike that names most inner points as well; counting over edges (above) is what the criterion can mean.
  for (const char* name : {"porthole", "nosecone", "sheet"}) {
    const auto part = synthetic::load_fe_part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe" / name);
    const TriangleMesh mesh = part.mesh(8.0, false);
    const auto triangles = triangles_of(mesh);
    const auto on = on_a_contour(mesh);
    const NearestPoints tree(mesh.vertices_mm);
    const double mean_mm = mean_edge_mm(mesh);
    std::vector<Neighbour> near;
    double agrees = 0.0, contour_named = 0.0, contour = 0.0;
    for (std::size_t v = 0; v < on.size(); ++v) {
      tree.within(mesh.vertices_mm[v], mean_mm, near);
      const bool named = static_cast<int>(near.size()) - 1 != triangles[v];  // without the point itself
      agrees += named == (on[v] != 0) ? 1.0 : 0.0;
      contour += on[v] ? 1.0 : 0.0;
      contour_named += on[v] && named ? 1.0 : 0.0;
    }
    const double agrees_ratio = agrees / static_cast<double>(on.size());
    RecordProperty(name, std::to_string(agrees_ratio));
    EXPECT_NEAR(agrees_ratio, 0.3, 0.12) << name;
    EXPECT_GT(contour_named / contour, 0.8) << name;
  }
}

}  // namespace
}  // namespace arris
