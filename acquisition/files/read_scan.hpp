#pragma once

#include <filesystem>

#include "acquisition/types/point_cloud.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Reads a scan by what the file holds, not by its name (a name that lies is an error that says so).
///   formats   PLY (ASCII, both byte orders, float and double), STL (ASCII, binary), PCD, delimited text, OFF
///   to_mm     what one unit of the file is in mm (1, 25.4, 1000); applied before the offset is taken
///   throws    Error(kInput): missing, empty, cut short, other kind than its name says, no finite point
/// Never allocates more than the file's own size justifies. Cost: one pass over the mapped file.
[[nodiscard]] Scan read_scan(const std::filesystem::path& file, double to_mm = 1.0);

/// Reads a mesh (PLY, STL, OFF), welding vertices that are equal bit for bit; mm, file coordinates, double.
///   throws   Error(kInput) as read_scan, and for a file without triangles
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& file, double to_mm = 1.0);

}  // namespace arris
