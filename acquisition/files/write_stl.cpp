#include "acquisition/files/write_stl.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <limits>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

void append(std::string& bytes, const Eigen::Vector3f& v) {
  char raw[12];
  std::memcpy(raw, v.data(), sizeof raw);
  bytes.append(raw, sizeof raw);
}

Eigen::Vector3f normal_of(const std::array<Eigen::Vector3d, 3>& corners) {
  const Eigen::Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double length = n.norm();
  return length > 0.0 ? Eigen::Vector3f((n / length).cast<float>())
                      : Eigen::Vector3f(Eigen::Vector3f::Zero());
}

}  // namespace

void write_stl(std::ostream& out, const TriangleMesh& mesh, const std::string& title) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(Fault::kBug, "write_stl: more triangles than the format can count");
  std::string bytes = "arris units mm " + title.substr(0, 60);
  bytes.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  char raw_count[4];
  std::memcpy(raw_count, &count, sizeof raw_count);
  bytes.append(raw_count, sizeof raw_count);
  for (const auto& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto index = static_cast<std::size_t>(triangle[i]);
      if (triangle[i] < 0 || index >= mesh.vertices_mm.size())
        throw Error(Fault::kBug, "write_stl: a triangle uses vertex " + std::to_string(triangle[i]) + " of " +
                                     std::to_string(mesh.vertices_mm.size()));
      corners[i] = mesh.vertices_mm[index];
    }
    append(bytes, normal_of(corners));
    for (const Eigen::Vector3d& corner : corners) append(bytes, corner.cast<float>());
    bytes.append(2, '\0');
    if (bytes.size() > (std::size_t{1} << 16)) {
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      bytes.clear();
    }
  }
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace arris
