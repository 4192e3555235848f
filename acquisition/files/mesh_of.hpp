#pragma once

#include "acquisition/files/source.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris::files {

/// The mesh of a file read with Source::wide: vertices that are equal bit for bit become one; triangles of no
/// area and vertices that no triangle uses are left out. Order as in the file.
[[nodiscard]] TriangleMesh mesh_of(Loaded loaded);

}  // namespace arris::files
