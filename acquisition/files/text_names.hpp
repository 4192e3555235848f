#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris::files {

/// A column name: "X [mm]" is role 0, unit "mm".
struct ColumnName {
  std::string name;  ///< as written, without quotes
  int role = -1;     ///< 0 1 2 = x y z, 3 4 5 = normal, -1 = anything else
  std::string unit;  ///< from brackets or a suffix, or empty
};

/// The names of a header line, cut at the separator of the rows where the line has it, else at blanks and
/// commas. Names i j k are a normal only beside x y z.
[[nodiscard]] std::vector<ColumnName> column_names(std::string_view line, char separator);

/// Whether x, y and z are all among them.
[[nodiscard]] bool names_coordinates(const std::vector<ColumnName>& names);

/// The cells of a line: at blanks (and only there) for ' ', else at the separator, trimmed.
[[nodiscard]] std::vector<std::string_view> cells_of(std::string_view line, char separator);

}  // namespace arris::files
