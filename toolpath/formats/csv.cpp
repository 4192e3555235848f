#include "toolpath/formats/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

using std::string;
using std::string_view;

const std::vector<string> kAxes = {"x", "y", "z", "nx", "ny", "nz"};
const std::vector<string> kKnown = {"x", "y", "z", "nx", "ny", "nz", "path", "feed_mm_s", "closed", "index"};

constexpr const char* kCorrect = "correct that line, or export the tool path again";

string_view trimmed(string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<string_view> fields_of(string_view line) {
  std::vector<string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.push_back(trimmed(line.substr(begin, comma == string_view::npos ? comma : comma - begin)));
    if (comma == string_view::npos) return fields;
    begin = comma + 1;
  }
}

std::optional<double> number_in(string_view field) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  double value = 0.0;
  const auto end = std::from_chars(field.data(), field.data() + field.size(), value);
  if (field.empty() || end.ec != std::errc() || end.ptr != field.data() + field.size()) return std::nullopt;
  return value;
}

std::size_t edit_distance(string_view a, string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t up = row[j];
      row[j] = std::min({up + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = up;
    }
  }
  return row[b.size()];
}

string nearest_known(string_view column) {
  return *std::min_element(kKnown.begin(), kKnown.end(), [&](const string& a, const string& b) {
    return edit_distance(a, column) < edit_distance(b, column);
  });
}

class Reader {
 public:
  Reader(string_view text, const string& source) : text_(text), source_(source) { out_.path.source = source; }

  PathCsv read() {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") text_.remove_prefix(3);
    if (trimmed_all(text_).empty()) fail_file("the tool path file is empty", "0 rows");
    for (std::size_t begin = 0; begin < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      ++line_;
      take_line(trimmed(text_.substr(begin, end - begin)));
      begin = end + 1;
    }
    if (out_.path.points.empty()) fail_file("the tool path has no rows", "0 rows");
    finish();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const string& what, const string& found, const string& needed,
                         const string& next = kCorrect) const {
    throw Error(Fault::kInput,
                ErrorText{what, source_ + ", line " + std::to_string(line_), found, needed, next});
  }
  [[noreturn]] void fail_file(const string& what, const string& found) const {
    throw Error(Fault::kInput, ErrorText{what, source_, found, "at least 1 row of x,y,z,nx,ny,nz",
                                         "export the tool path again"});
  }
  static string_view trimmed_all(string_view text) {
    const auto first = text.find_first_not_of(" \t\r\n");
    return first == string_view::npos ? string_view() : text.substr(first);
  }

  void take_line(string_view line) {
    if (line.empty()) return;
    if (line.front() == '#') {
      if (line.find("result_hash") != string_view::npos) refuse_corrected("a result_hash comment");
      return;
    }
    const std::vector<string_view> fields = fields_of(line);
    if (fields.size() > 1 &&
        std::all_of(fields.begin() + 1, fields.end(), [](string_view f) { return f.empty(); })) {
      ++separators_;
      new_polyline_ = true;
      return;
    }
    if (fields.size() == 1 && line.find_first_of(";\t") != string_view::npos)
      fail("the fields are not separated by commas", "semicolons or tabs", "commas, and decimal points");
    if (columns().empty() && !take_header(fields)) return;
    take_row(fields);
  }

  [[noreturn]] void refuse_corrected(const string& found) const {
    fail("this path is corrected already", found, "a nominal path in the CAD frame",
         "give the nominal path; correcting twice would move it twice");
  }

  std::vector<string>& columns() { return out_.path.columns; }

  // Sets the columns; true when the line is a row already (no header).
  bool take_header(const std::vector<string_view>& fields) {
    if (number_in(fields.front())) {
      if (fields.size() != 6 && fields.size() != 7)
        fail("a line without a header before it", std::to_string(fields.size()) + " fields",
             "x,y,z,nx,ny,nz or index,x,y,z,nx,ny,nz", "add a header line");
      if (fields.size() == 7) columns().push_back("index");
      columns().insert(columns().end(), kAxes.begin(), kAxes.end());
      return true;
    }
    for (string_view field : fields) take_column(string(field));
    for (const string& axis : kAxes)
      if (std::find(columns().begin(), columns().end(), axis) == columns().end())
        fail("the header lacks a column", "no column '" + axis + "'", "x,y,z,nx,ny,nz");
    return false;
  }

  void take_column(string column) {
    std::transform(column.begin(), column.end(), column.begin(), [](unsigned char c) {
      return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    if (column == "shift_mm") refuse_corrected("a column shift_mm");
    if (std::find(kKnown.begin(), kKnown.end(), column) == kKnown.end())
      fail("unknown column", "'" + column + "'",
           "x,y,z,nx,ny,nz, and path, feed_mm_s, closed, index as needed",
           "did you mean '" + nearest_known(column) + "'?");
    if (std::find(columns().begin(), columns().end(), column) != columns().end())
      fail("a column stands twice", "'" + column + "'", "each column once");
    columns().push_back(column);
  }

  double number(string_view field, const string& column) const {
    const std::optional<double> value = number_in(field);
    if (!value)
      fail("not a number in column " + column, "'" + string(field) + "'", "a number with a decimal point");
    if (!std::isfinite(*value))
      fail("not a finite number in column " + column, "'" + string(field) + "'", "a finite number");
    return *value;
  }

  long whole(string_view field, const string& column) const {
    const double value = number(field, column);
    if (value != std::floor(value) || std::abs(value) > 2e9)
      fail("not a whole number in column " + column, "'" + string(field) + "'", "a whole number");
    return static_cast<long>(value);
  }

  void take_row(const std::vector<string_view>& fields) {
    if (fields.size() != columns().size())
      fail("wrong number of fields", std::to_string(fields.size()), std::to_string(columns().size()));
    PathPoint row;
    row.path = out_.path.points.empty() ? 1 : out_.path.points.back().path + (new_polyline_ ? 1 : 0);
    for (std::size_t i = 0; i < fields.size(); ++i) take_field(columns()[i], fields[i], row);
    take_axis(row);
    take_order(row);
    out_.path.points.push_back(row);
    new_polyline_ = false;
  }

  void take_field(const string& column, string_view field, PathPoint& row) {
    const auto axis = std::find(kAxes.begin(), kAxes.end(), column) - kAxes.begin();
    if (axis < 3) {
      row.tip_mm[axis] = number(field, column);
    } else if (axis < 6) {
      row.axis[axis - 3] = number(field, column);
    } else if (column == "path") {
      row.path = static_cast<int>(whole(field, column));
    } else if (column == "index") {
      out_.path.index.push_back(whole(field, column));
    } else if (column == "feed_mm_s") {
      row.feed_mm_s = number(field, column);
      if (row.feed_mm_s < 0.0) fail("a negative feed", string(field), ">= 0 (0: the recipe's feed)");
    } else {
      const long closed = whole(field, column);
      if (closed != 0 && closed != 1) fail("not a yes or no in column closed", string(field), "0 or 1");
      row.closed = closed == 1;
    }
  }

  void take_axis(PathPoint& row) {
    const double length = row.axis.norm();
    if (!(std::abs(length - 1.0) <= 0.01))
      fail("the axis nx,ny,nz is not a unit vector", "length " + std::to_string(length), "1 within 1 %");
    normalised_ += std::abs(length - 1.0) > 1e-4 ? 1 : 0;
    row.axis /= length;
  }

  void take_order(const PathPoint& row) {
    const bool first = out_.path.points.empty();
    if (!first && out_.path.points.back().path == row.path) {
      if (out_.path.points.back().closed != row.closed)
        fail("column closed changes within polyline " + std::to_string(row.path), row.closed ? "1" : "0",
             "one value a polyline");
      return;
    }
    if (!seen_.insert(row.path).second)
      fail("polyline " + std::to_string(row.path) + " is taken up again after another",
           "its rows in two places", "consecutive rows", "give the second part a number of its own");
  }

  bool has(const string& column) {
    return std::find(columns().begin(), columns().end(), column) != columns().end();
  }

  void finish() {
    ToolPath& path = out_.path;
    path.has_feed_column = has("feed_mm_s");
    path.has_closed_column = has("closed");
    path.has_path_column = has("path");
    if (!path.has_path_column && seen_.size() > 1) {
      columns().push_back("path");
      path.has_path_column = true;
    }
    if (separators_ > 0)
      out_.notes.push_back(std::to_string(separators_) + " separator lines, read as " +
                           std::to_string(seen_.size()) + (seen_.size() == 1 ? " polyline" : " polylines"));
    if (normalised_ > 0)
      out_.notes.push_back(std::to_string(normalised_) +
                           " axes were off length 1 by up to 1 % and were brought to it");
  }

  string_view text_;
  string source_;
  PathCsv out_;
  std::set<int> seen_;
  std::size_t line_ = 0, separators_ = 0, normalised_ = 0;
  bool new_polyline_ = false;
};

}  // namespace

PathCsv read_path_csv(string_view text, const string& source) {
  return Reader(text, source).read();
}

}  // namespace arris
