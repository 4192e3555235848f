#include "acquisition/files/text_names.hpp"

#include <algorithm>
#include <utility>

#include "acquisition/files/source.hpp"

namespace arris::files {
namespace {

int role_of(std::string_view name) {
  static constexpr std::pair<std::string_view, int> kNames[] = {
      {"x", 0},        {"y", 1},        {"z", 2},        {"px", 0},        {"py", 1},        {"pz", 2},
      {"x_coord", 0},  {"y_coord", 1},  {"z_coord", 2},  {"pos_x", 0},     {"pos_y", 1},     {"pos_z", 2},
      {"points:0", 0}, {"points:1", 1}, {"points:2", 2}, {"nx", 3},        {"ny", 4},        {"nz", 5},
      {"normal_x", 3}, {"normal_y", 4}, {"normal_z", 5}, {"normals:0", 3}, {"normals:1", 4}, {"normals:2", 5},
      {"normalx", 3},  {"normaly", 4},  {"normalz", 5},  {"i", 3},         {"j", 4},         {"k", 5}};
  for (const auto& [known, role] : kNames)
    if (known == name) return role;
  return -1;
}

std::string_view without_quotes(std::string_view cell) {
  while (cell.size() >= 2 && (cell.front() == '"' || cell.front() == '\'') && cell.back() == cell.front())
    cell = trimmed(cell.substr(1, cell.size() - 2));
  return cell;
}

ColumnName column_name(std::string_view cell) {
  ColumnName column;
  cell = without_quotes(cell);
  column.name = std::string(cell);
  std::string plain = lower(cell);
  const std::size_t bracket = plain.find_first_of("[(");
  if (bracket != std::string::npos && bracket > 0) {
    const std::size_t close = plain.find_first_of("])", bracket);
    column.unit = unit_of_word(trimmed(std::string_view(plain).substr(bracket + 1, close - bracket - 1)));
    plain = std::string(trimmed(std::string_view(plain).substr(0, bracket)));
  }
  const std::size_t suffix = plain.rfind('_');
  if (suffix != std::string::npos && suffix > 0) {
    const std::string unit = unit_of_word(std::string_view(plain).substr(suffix + 1));
    if (!unit.empty()) {
      column.unit = unit;
      plain.resize(suffix);
    }
  }
  column.role = role_of(plain);
  return column;
}

/// Only the first column of each role counts, and a normal only when it is whole.
void keep_first_of_each(std::vector<ColumnName>& columns) {
  bool seen[6] = {};
  for (ColumnName& column : columns) {
    if (column.role < 0) continue;
    bool& taken = seen[column.role];
    if (taken) column.role = -1;
    taken = true;
  }
  if (seen[3] && seen[4] && seen[5]) return;
  for (ColumnName& column : columns)
    if (column.role >= 3) column.role = -1;
}

}  // namespace

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  if (separator == ' ') return words_of(line);
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

std::vector<ColumnName> column_names(std::string_view line, char separator) {
  std::vector<ColumnName> columns;
  if (separator != ' ' && line.find(separator) != std::string_view::npos) {
    for (const std::string_view cell : cells_of(line, separator)) columns.push_back(column_name(cell));
  } else {
    std::string spaced(line);
    std::replace_if(
        spaced.begin(), spaced.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    for (const std::string_view word : words_of(spaced)) {
      const bool unit_alone = word.front() == '[' || word.front() == '(';
      if (unit_alone && !columns.empty())
        columns.back().unit = unit_of_word(word.substr(1, word.find_first_of("])") - 1));
      else
        columns.push_back(column_name(word));
    }
  }
  keep_first_of_each(columns);
  return columns;
}

bool names_coordinates(const std::vector<ColumnName>& names) {
  for (int role = 0; role < 3; ++role)
    if (std::none_of(names.begin(), names.end(), [role](const ColumnName& c) { return c.role == role; }))
      return false;
  return true;
}

}  // namespace arris::files
