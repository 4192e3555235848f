#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "acquisition/files/point_sink.hpp"

namespace arris::files {

/// How the rows of a text are cut into numbers.
struct RowLayout {
  char separator =
      ' ';  ///< ' ': any run of blanks and tabs; else this one character, blanks beside it skipped
  bool decimal_comma = false;  ///< 1,5 is a number (so is 1.5)
  bool comments = true;        ///< rows that begin with # or // are skipped
  std::vector<int>
      roles;  ///< per column: 0 1 2 = x y z, 3 4 5 = normal, -1 = not used; ends at the last used one

  [[nodiscard]] bool with_normals() const;
};

/// Parses every row of `text` (a part of source.bytes) on all cores; the same bytes for any number of them.
///   returns  the number of points stored, finite or not
///   throws   Error(kInput) with the line of the first row that is short or holds no number where one is
///   needed
[[nodiscard]] std::size_t load_text_rows(const Source& source, std::string_view text, const RowLayout& layout,
                                         Loaded& out);

/// Parses one line into values[role]; false when it is no row of this layout.
[[nodiscard]] bool parse_row(std::string_view line, const RowLayout& layout, double (&values)[6]);

}  // namespace arris::files
