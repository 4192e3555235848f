#include "acquisition/vertex_at.hpp"

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

std::array<double, 3> key_of(const Eigen::Vector3d& p_mm) {
  return {p_mm.x(), p_mm.y(), p_mm.z()};
}

}  // namespace

VertexAt::VertexAt(const TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices_mm.size(); ++v) number_.emplace(key_of(mesh.vertices_mm[v]), v);
}

std::size_t VertexAt::operator()(const Eigen::Vector3d& p_mm) const {
  const auto found = number_.find(key_of(p_mm));
  if (found == number_.end()) throw Error(Fault::kBug, "a contour point is no vertex of its mesh");
  return found->second;
}

}  // namespace arris
