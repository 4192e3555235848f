// Any bytes are a scan, a mesh or one Error; never a crash, a hang, a wild allocation or a point that is not
// finite. The first byte chooses a name (so that each reader is reached) and the precision; the rest is the
// file.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "acquisition/files/load_file.hpp"
#include "acquisition/files/mesh_of.hpp"
#include "acquisition/types/error.hpp"

namespace {

/// An exception that nobody catches is a crash to the fuzzer, and its text is in the report.
void need(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

void check(arris::files::Loaded loaded, bool wide) {
  const std::size_t points = loaded.points();
  need(points > 0, "a file without points is refused");
  need(loaded.normals.empty() || loaded.normals.size() == points, "one normal a point");
  for (const Eigen::Vector3f& p : loaded.near_mm) need(p.allFinite(), "points are finite");
  for (const Eigen::Vector3d& p : loaded.wide_mm) need(p.allFinite(), "points are finite");
  for (const auto& triangle : loaded.triangles)
    for (const std::int32_t corner : triangle)
      need(corner >= 0 && static_cast<std::size_t>(corner) < points, "triangles use points that exist");
  if (!wide) return;
  const arris::TriangleMesh mesh = arris::files::mesh_of(std::move(loaded));
  need(mesh.vertices_mm.size() <= points, "welding makes no points");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  static constexpr const char* kNames[] = {"scan",  "a.ply", "a.stl", "a.pcd",
                                           "a.off", "a.csv", "a.pts", "a.xyz"};
  const bool wide = (data[0] & 8) != 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    check(arris::files::load_bytes({bytes, kNames[data[0] & 7], 1.0, wide}), wide);
  } catch (const arris::Error& error) {
    need(error.fault() == arris::Fault::kInput, "what is wrong with a file is an input error");
    need(std::string_view(error.what()).find('\n') == std::string_view::npos, "an error is one line");
  }
  return 0;
}
