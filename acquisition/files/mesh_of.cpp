#include "acquisition/files/mesh_of.hpp"

#include <Eigen/Geometry>
#include <utility>

#include "acquisition/files/weld.hpp"

namespace arris::files {
namespace {

bool has_area(const std::vector<Eigen::Vector3d>& p, const std::array<std::int32_t, 3>& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  const auto at = [&](int corner) {
    return p[static_cast<std::size_t>(t[static_cast<std::size_t>(corner)])];
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).squaredNorm() > 0.0;
}

void drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<std::int32_t> place(mesh.vertices_mm.size(), -1);
  for (const auto& triangle : mesh.triangles)
    for (const std::int32_t corner : triangle) place[static_cast<std::size_t>(corner)] = 0;
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < 0) continue;
    mesh.vertices_mm[static_cast<std::size_t>(kept)] = mesh.vertices_mm[i];
    place[i] = kept++;
  }
  mesh.vertices_mm.resize(static_cast<std::size_t>(kept));
  for (auto& triangle : mesh.triangles)
    for (std::int32_t& corner : triangle) corner = place[static_cast<std::size_t>(corner)];
}

}  // namespace

TriangleMesh mesh_of(Loaded loaded) {
  Welder<double> welder(6 * loaded.wide_mm.size());
  std::vector<std::int32_t> index(loaded.wide_mm.size());
  welder.add(loaded.wide_mm, index.data());
  TriangleMesh mesh;
  mesh.vertices_mm = std::move(welder.points());
  mesh.triangles = std::move(loaded.triangles);
  for (auto& triangle : mesh.triangles)
    for (std::int32_t& corner : triangle) corner = index[static_cast<std::size_t>(corner)];
  std::erase_if(mesh.triangles, [&](const auto& triangle) { return !has_area(mesh.vertices_mm, triangle); });
  drop_unused_vertices(mesh);
  return mesh;
}

}  // namespace arris::files
