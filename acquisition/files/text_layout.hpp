#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/files/text_rows.hpp"

namespace arris::files {

/// What the first lines of a delimited text say about the rest.
struct TextLayout {
  RowLayout row;
  std::size_t rows_at = 0;               ///< first byte of the rows (comments may still stand between them)
  std::optional<std::size_t> announced;  ///< points that the first line promises (.pts)
  std::string unit_hint;                 ///< from a comment or from a column name like "x [mm]"
  std::vector<std::string> extra_names;  ///< columns beyond coordinates and normals
  std::vector<std::string> notes;
};

/// Finds separator, decimal comma, header and columns from the head of the file.
///   separator   ; then tab then , then blanks, by what the first rows hold
///   header      a row of names, or a comment of names; x, y and z must be among them. Without: columns 1 to
///   3 normals     columns nx ny nz (or i j k) of a header; without one columns 4 to 6 when all first rows
///   hold unit vectors refuses     fewer than 3 columns, a header without x, y, z, a first column that only
///   counts the rows
[[nodiscard]] TextLayout find_text_layout(const Source& source);

}  // namespace arris::files
