#include "acquisition/files/text_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "acquisition/files/number.hpp"
#include "acquisition/files/text_names.hpp"

namespace arris::files {
namespace {

constexpr std::size_t kHeadLines = 200;  // rows that are looked at
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_number(std::string_view cell) {
  double value = 0.0;
  return !cell.empty() &&
         parse_number(cell.data(), cell.data() + cell.size(), true, value) == cell.data() + cell.size();
}

/// A row of names: a word in it begins with a letter or a quote and is no number (nan is one).
bool is_header(std::string_view line) {
  std::string spaced(line);
  std::replace_if(
      spaced.begin(), spaced.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  const auto words = words_of(spaced);
  return std::any_of(words.begin(), words.end(), [](std::string_view word) {
    const char c = word.front();
    const bool wordy = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '"' || c == '\'' || c == '_';
    return wordy && !is_number(word);
  });
}

std::string_view without_comment_mark(std::string_view line) {
  line = trimmed(line);
  const std::size_t first = line.find_first_not_of("#/");
  return first == std::string_view::npos ? std::string_view{} : line.substr(first);
}

bool is_comment(std::string_view line) {
  line = trimmed(line);
  return line.substr(0, 1) == "#" || line.substr(0, 2) == "//";
}

/// The first lines, sorted by what they are.
struct Head {
  std::string_view header;             ///< a row of names, or empty
  std::string_view comment;            ///< the last comment before the rows, without its mark
  std::vector<std::string_view> rows;  ///< the first rows of numbers
  std::size_t rows_at = 0;
  std::optional<std::size_t> announced;
  std::string unit_hint;
};

std::optional<std::size_t> lone_count(std::string_view line) {
  line = trimmed(line);
  std::size_t count = 0;
  const auto result = std::from_chars(line.data(), line.data() + line.size(), count);
  if (line.empty() || result.ec != std::errc() || result.ptr != line.data() + line.size())
    return std::nullopt;
  return count;
}

Head head_of(std::string_view bytes) {
  Head head;
  std::string_view rest = bytes;
  if (rest.substr(0, 3) == kByteOrderMark) rest.remove_prefix(3);
  while (!rest.empty() && head.rows.size() < kHeadLines) {
    const std::string_view line = take_line(rest);
    if (trimmed(line).empty()) continue;
    const bool before_rows = head.rows.empty();
    if (is_comment(line)) {
      if (before_rows) head.comment = without_comment_mark(line);
      if (head.unit_hint.empty()) head.unit_hint = unit_in(line);
      continue;
    }
    if (before_rows && !head.announced && head.header.empty() && lone_count(line)) {
      head.announced = lone_count(line);
      continue;
    }
    if (before_rows && head.header.empty() && is_header(line)) {
      head.header = line;
      continue;
    }
    if (before_rows) head.rows_at = static_cast<std::size_t>(line.data() - bytes.data());
    head.rows.push_back(line);
  }
  return head;
}

bool every(const std::vector<std::string_view>& rows, const auto& holds) {
  return std::all_of(rows.begin(), rows.end(), holds);
}

bool any_has(const std::vector<std::string_view>& rows, char c) {
  return std::any_of(rows.begin(), rows.end(), [c](std::string_view row) { return row.find(c) != row.npos; });
}

/// "1,5 2,5 3,5": words with one comma between digits at most, and no point anywhere.
bool blanks_and_decimal_commas(const std::vector<std::string_view>& rows) {
  if (any_has(rows, '.')) return false;
  return every(rows, [](std::string_view row) {
    const auto words = words_of(row);
    return words.size() >= 3 && every(words, [](std::string_view word) {
             return std::count(word.begin(), word.end(), ',') <= 1 && word.front() != ',' &&
                    word.back() != ',';
           });
  });
}

/// Tabs between all cells, and no cell that holds a blank or ends with a comma.
bool tabs_between(const std::vector<std::string_view>& rows) {
  return every(rows, [](std::string_view row) {
    const auto cells = cells_of(row, '\t');
    return cells.size() >= 3 && every(cells, [](std::string_view cell) {
             return cell.find(' ') == cell.npos && (cell.empty() || cell.back() != ',');
           });
  });
}

void find_separator(const std::vector<std::string_view>& rows, RowLayout& row) {
  if (any_has(rows, ';')) {
    row.separator = ';';
    row.decimal_comma = true;
  } else if (tabs_between(rows)) {
    row.separator = '\t';
    row.decimal_comma = true;
  } else if (any_has(rows, ',')) {
    row.decimal_comma = blanks_and_decimal_commas(rows);
    row.separator = row.decimal_comma ? ' ' : ',';
  }
}

/// Columns 4 to 6 hold unit vectors in all first rows: nothing else does.
bool unit_vectors_follow(const std::vector<std::string_view>& rows, const RowLayout& layout) {
  RowLayout six = layout;
  six.roles = {0, 1, 2, 3, 4, 5};
  return rows.size() >= 3 && every(rows, [&](std::string_view row) {
           double v[6];
           return parse_row(row, six, v) && std::abs(std::hypot(v[3], v[4], v[5]) - 1.0) < 1e-3;
         });
}

/// Plain 0 1 2 .. or 1 2 3 .. in front of numbers with decimals: a row number, not a coordinate.
bool first_column_counts(const std::vector<std::string_view>& rows, char separator) {
  std::size_t expected = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto cells = cells_of(rows[i], separator);
    if (cells.size() < 4) return false;
    const auto count = lone_count(cells[0]);
    if (!count || (i == 0 && *count > 1) || (i > 0 && *count != expected)) return false;
    if (cells[1].find_first_of(".,") == std::string_view::npos) return false;
    expected = *count + 1;
  }
  return rows.size() >= 3;
}

void use_names(const std::vector<ColumnName>& names, TextLayout& layout) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].role >= 0) {
      layout.row.roles.resize(i + 1, -1);
      layout.row.roles[i] = names[i].role;
      if (layout.unit_hint.empty() && names[i].role < 3) layout.unit_hint = names[i].unit;
    } else if (!names[i].name.empty()) {
      layout.extra_names.push_back(names[i].name);
    }
  }
}

void use_positions(const Source& source, const Head& head, TextLayout& layout) {
  const std::size_t columns = cells_of(head.rows[0], layout.row.separator).size();
  if (columns < 3)
    throw bad_file(source, "the rows have too few columns", line_of(source, head.rows[0].data()),
                   std::to_string(columns) + " in '" + printable(trimmed(head.rows[0])) + "'", "x, y and z",
                   "export the points with three coordinates");
  if (first_column_counts(head.rows, layout.row.separator))
    throw bad_file(source, "the first column counts the rows, so x, y, z are not where they seem", "",
                   quoted(trimmed(head.rows[0])), "a header that names the columns",
                   "add a first line like index,x,y,z");
  layout.row.roles = {0, 1, 2};
  const bool normals = columns >= 6 && unit_vectors_follow(head.rows, layout.row);
  if (normals) {
    layout.row.roles = {0, 1, 2, 3, 4, 5};
    layout.notes.push_back("columns 4 to 6 hold unit vectors and are read as normals");
  }
  for (std::size_t i = normals ? 6 : 3; i < columns; ++i)
    layout.extra_names.push_back("column " + std::to_string(i + 1));
}

}  // namespace

TextLayout find_text_layout(const Source& source) {
  const Head head = head_of(source.bytes);
  if (head.rows.empty())
    throw bad_file(source, "the file holds no points", "", "no row of numbers", "rows with x, y and z",
                   "export the scan again");
  TextLayout layout;
  layout.rows_at = head.rows_at;
  layout.announced = head.announced;
  layout.unit_hint = head.unit_hint;
  find_separator(head.rows, layout.row);
  std::vector<ColumnName> names = column_names(head.header, layout.row.separator);
  if (!head.header.empty() && !names_coordinates(names))
    throw bad_file(source, "the header does not name the coordinates", line_of(source, head.header.data()),
                   quoted(trimmed(head.header)), "columns named x, y and z",
                   "name the columns, or put # before a title line");
  if (head.header.empty()) {
    names = column_names(head.comment, layout.row.separator);
    if (!names_coordinates(names) || names.size() > cells_of(head.rows[0], layout.row.separator).size())
      names.clear();
  }
  if (names.empty())
    use_positions(source, head, layout);
  else
    use_names(names, layout);
  return layout;
}

}  // namespace arris::files
