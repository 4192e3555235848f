#pragma once

#include <array>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "acquisition/types/point_cloud.hpp"
#include "acquisition/types/triangle_mesh.hpp"

namespace arris {

/// What a PLY file may hold beside the points; each span is empty or has one entry a point.
struct PlyExtras {
  std::span<const float> deviation_mm;                     ///< scalar property deviation_mm
  std::span<const std::array<std::uint8_t, 3>> rgb;        ///< red green blue
  std::span<const std::array<std::int32_t, 3>> triangles;  ///< element face
  std::vector<std::string> comments;                       ///< a line each; line ends in them become blanks
};

/// Writes binary little endian PLY in file coordinates: x y z as float when the offset is zero, as double
/// otherwise, so that reading the file again gives the same points; then nx ny nz, deviation_mm and colour
/// where given. The same values give the same bytes. A comment says that the unit is mm.
///   throws   Error(kBug) when a span has another length than the cloud, or a triangle an index outside it
/// Whether the bytes arrived is the stream's to say (AtomicFile::commit).
void write_ply(std::ostream& out, const PointCloud& cloud, const PlyExtras& extras = {});

/// The same of a mesh, in double.
void write_ply(std::ostream& out, const TriangleMesh& mesh, const std::vector<std::string>& comments = {});

}  // namespace arris
