#include "acquisition/files/write_ply.hpp"

#include <cstring>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

/// Collects small values into large writes.
class ByteWriter {
 public:
  explicit ByteWriter(std::ostream& out) : out_(out) { buffer_.reserve(kBufferBytes + 64); }
  ~ByteWriter() { flush(); }
  ByteWriter(const ByteWriter&) = delete;
  ByteWriter& operator=(const ByteWriter&) = delete;

  template <class T>
  void put(const T& value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    buffer_.append(bytes, sizeof value);
    if (buffer_.size() >= kBufferBytes) flush();
  }

 private:
  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

  std::ostream& out_;
  std::string buffer_;
};

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

std::string header_front(const std::vector<std::string>& comments, std::size_t points, const char* real) {
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment units mm\n";
  for (const std::string& comment : comments) header += "comment " + one_line(comment) + "\n";
  header += "element vertex " + std::to_string(points) + "\n";
  for (const char* axis : {"x", "y", "z"}) header += std::string("property ") + real + " " + axis + "\n";
  return header;
}

std::string header_end(std::size_t triangles) {
  if (triangles == 0) return "end_header\n";
  return "element face " + std::to_string(triangles) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void check(const PointCloud& cloud, const PlyExtras& extras) {
  const auto fits = [&](std::size_t size) { return size == 0 || size == cloud.size(); };
  if (!fits(cloud.normals.size()) || !fits(extras.deviation_mm.size()) || !fits(extras.rgb.size()))
    throw Error(Fault::kBug, "write_ply: a property has another length than the " +
                                 std::to_string(cloud.size()) + " points");
}

void check_triangles(std::span<const std::array<std::int32_t, 3>> triangles, std::size_t points) {
  for (const auto& triangle : triangles)
    for (const std::int32_t corner : triangle)
      if (corner < 0 || static_cast<std::size_t>(corner) >= points)
        throw Error(Fault::kBug, "write_ply: a triangle uses point " + std::to_string(corner) + " of " +
                                     std::to_string(points));
}

void put_triangles(ByteWriter& bytes, std::span<const std::array<std::int32_t, 3>> triangles) {
  for (const auto& triangle : triangles) {
    bytes.put(std::uint8_t{3});
    for (const std::int32_t corner : triangle) bytes.put(corner);
  }
}

}  // namespace

void write_ply(std::ostream& out, const PointCloud& cloud, const PlyExtras& extras) {
  check(cloud, extras);
  check_triangles(extras.triangles, cloud.size());
  const bool wide = !cloud.offset_mm.isZero(0.0);
  const bool normals = cloud.has_normals();
  std::string header = header_front(extras.comments, cloud.size(), wide ? "double" : "float");
  if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!extras.deviation_mm.empty()) header += "property float deviation_mm\n";
  if (!extras.rgb.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += header_end(extras.triangles.size());
  out.write(header.data(), static_cast<std::streamsize>(header.size()));
  ByteWriter bytes(out);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (wide)
        bytes.put(static_cast<double>(cloud.points_mm[i][axis]) + cloud.offset_mm[axis]);
      else
        bytes.put(cloud.points_mm[i][axis]);
    }
    for (int axis = 0; normals && axis < 3; ++axis) bytes.put(cloud.normals[i][axis]);
    if (!extras.deviation_mm.empty()) bytes.put(extras.deviation_mm[i]);
    if (!extras.rgb.empty()) bytes.put(extras.rgb[i]);
  }
  put_triangles(bytes, extras.triangles);
}

void write_ply(std::ostream& out, const TriangleMesh& mesh, const std::vector<std::string>& comments) {
  check_triangles(mesh.triangles, mesh.vertices_mm.size());
  const std::string header =
      header_front(comments, mesh.vertices_mm.size(), "double") + header_end(mesh.triangles.size());
  out.write(header.data(), static_cast<std::streamsize>(header.size()));
  ByteWriter bytes(out);
  for (const Eigen::Vector3d& p : mesh.vertices_mm)
    for (int axis = 0; axis < 3; ++axis) bytes.put(p[axis]);
  put_triangles(bytes, mesh.triangles);
}

}  // namespace arris
