#pragma once

#include <filesystem>

#include "acquisition/types/point_cloud.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// Reads a scan by what the file holds, not by its name (a name that lies is an error that says so).
///   formats   PLY (ASCII, both byte orders, every scalar type, faces), STL (ASCII, binary), PCD (ascii,
///   binary,
///             binary_compressed), OFF, delimited text (blank, tab, comma, semicolon; decimal comma; header
///             or not; .pts with its count)
///   to_mm     what one unit of the file is in mm (1, 25.4, 1000); applied before the offset is taken
///   offset    zero when the points lie within 1 m of the origin, so that a file of float32 keeps every bit;
///   else their
///             median in whole mm. No point of a part up to 2 m across moves by more than 0.0001 mm, however
///             far from the origin it lies; in a larger cloud a point moves by at most 6e-8 of its distance
///             from the offset
///   normals   made unit length; a point whose normal is zero or not finite in the file has a zero normal (a
///   note says
///             how many), and when these are more than half the cloud has none
///   triangles polygons as fans; STL corners that are equal bit for bit are one point. Points of PLY and OFF
///   stay as
///             they are
///   dropped   points that are NaN, infinite or beyond 1e11 mm, counted; with them the triangles that use
///   them throws    Error(kInput), one line each: missing, a folder, not readable, empty, cut short, another
///   kind than its
///             name says, a kind that is not read, a row or header that cannot be understood (with its line),
///             an index without a point, no finite point. Error(kRecipe): to_mm not above 0
/// Reads all cores wide, with the same bytes for any number of them; never allocates more than the file's own
/// size justifies. The file is mapped: it must not be made shorter while it is read.
[[nodiscard]] Scan read_scan(const std::filesystem::path& file, double to_mm = 1.0);

/// Reads a mesh (PLY, STL, OFF) in double and file coordinates, mm: vertices that are equal bit for bit
/// become one, triangles without area and vertices that no triangle uses are left out (inspect_file() counts
/// the former).
///   throws   Error(kInput) as read_scan(), and for a file without triangles or without any area, and when a
///   triangle
///            uses a point that is not finite: a drawing with a hole nobody asked for is no drawing
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& file, double to_mm = 1.0);

}  // namespace arris
