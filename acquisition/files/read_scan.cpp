#include "acquisition/files/read_scan.hpp"

#include <utility>

#include "acquisition/files/load_file.hpp"
#include "acquisition/files/mesh_of.hpp"

namespace arris {

Scan read_scan(const std::filesystem::path& file, double to_mm) {
  files::Loaded loaded = files::load_file(file, to_mm, false);
  Scan scan;
  scan.cloud.offset_mm = loaded.offset_mm;
  scan.cloud.points_mm = std::move(loaded.near_mm);
  scan.cloud.normals = std::move(loaded.normals);
  scan.triangles = std::move(loaded.triangles);
  scan.format = std::move(loaded.format);
  scan.unit_hint = std::move(loaded.unit_hint);
  scan.dropped_nonfinite = loaded.nonfinite;
  scan.notes = std::move(loaded.notes);
  return scan;
}

TriangleMesh read_mesh(const std::filesystem::path& file, double to_mm) {
  files::Loaded loaded = files::load_file(file, to_mm, true);
  const files::Source source{{}, file.string(), to_mm, true};
  if (loaded.triangles.empty())
    throw files::bad_file(source, "the file holds no triangles", "",
                          std::to_string(loaded.points()) + " points (" + loaded.format + ")", "a mesh",
                          "export the drawing as STL, or name a scan where a scan is meant");
  TriangleMesh mesh = files::mesh_of(std::move(loaded));
  if (mesh.empty())
    throw files::bad_file(source, "no triangle of the mesh has an area", "", "only degenerate triangles",
                          "a surface", "check the unit and the export settings of the drawing");
  return mesh;
}

}  // namespace arris
