#pragma once

#include <array>
#include <string_view>

#include "acquisition/files/ply_header.hpp"

namespace arris::files {

/// Which properties of the vertex element are used: x y z, and nx ny nz or -1.
struct PlyVertexPlan {
  std::array<int, 6> at = {-1, -1, -1, -1, -1, -1};

  [[nodiscard]] bool with_normals() const { return at[5] >= 0; }
  /// What property i is for: 0..5, or -1.
  [[nodiscard]] int role_of(std::size_t property) const;
};

/// Bodies; the header has been checked: one vertex element with x, y and z. Every element is walked to its
/// end, so that a file that was cut short anywhere is refused.
void load_ply_binary(const Source& source, const PlyHeader& header, const PlyVertexPlan& plan, Loaded& out);
void load_ply_ascii(const Source& source, const PlyHeader& header, const PlyVertexPlan& plan, Loaded& out);

/// The first element named vertex, or null.
[[nodiscard]] const PlyElement* vertex_of(const PlyHeader& header);

/// Index of the list that holds the corners of faces, or -1.
[[nodiscard]] int corner_list_of(const PlyElement& element);

[[nodiscard]] Error ply_ends_early(const Source& source, const PlyElement& element, std::size_t rows);

}  // namespace arris::files
