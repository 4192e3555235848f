#include "acquisition/contour_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/mapped_file.hpp"
#include "acquisition/files/number.hpp"
#include "acquisition/files/source.hpp"
#include "acquisition/files/text_names.hpp"

namespace arris {
namespace {

using files::Source;

constexpr int kPath = 6, kClosed = 7, kPassedOver = 8;  // roles of columns beyond x, y, z, nx, ny, nz
constexpr std::array<std::string_view, 8> kRoleNames{"x", "y", "z", "nx", "ny", "nz", "path", "closed"};
constexpr double kRepeated_mm = 1e-6;

char separator_of(std::string_view header) {
  for (const char separator : {';', '\t', ','})
    if (header.find(separator) != std::string_view::npos) return separator;
  return ' ';
}

/// One row by role, with the place that messages name.
struct Row {
  std::array<double, 8> value{};
  const char* place = nullptr;

  [[nodiscard]] Eigen::Vector3d point() const { return {value[0], value[1], value[2]}; }
  [[nodiscard]] Eigen::Vector3d normal() const { return {value[3], value[4], value[5]}; }
  [[nodiscard]] int path() const { return static_cast<int>(value[kPath]); }
  [[nodiscard]] bool closed() const { return value[kClosed] != 0.0; }
};

class ContourReader {
 public:
  explicit ContourReader(const Source& source) : source_(source) {}

  std::vector<Contour> read() {
    std::string_view rest = source_.bytes;
    if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);
    while (!rest.empty()) {
      const std::string_view line = files::trimmed(files::take_line(rest));
      if (line.empty() || line.front() == '#') continue;
      if (roles_.empty())
        take_header(line);
      else
        take_row(line);
    }
    if (contours_.empty())
      throw files::bad_file(source_, "the contour file holds no points", "", "no row of numbers",
                            "a header and rows of x,y,z,nx,ny,nz", "export the contour again");
    finish_contour();
    return std::move(contours_);
  }

 private:
  [[noreturn]] void fail(const char* place, const std::string& what, const std::string& found,
                         const std::string& needed,
                         const std::string& next = "correct the line, or export the contour again") const {
    throw files::bad_file(source_, what, files::line_of(source_, place), found, needed, next);
  }

  [[nodiscard]] bool has(int role) const {
    return std::find(roles_.begin(), roles_.end(), role) != roles_.end();
  }

  void take_header(std::string_view line) {
    separator_ = separator_of(line);
    for (const files::ColumnName& column : files::column_names(line, separator_))
      take_column(column, line.data());
    for (const std::size_t role : {0, 1, 2, 3, 4, 5})
      if (!has(static_cast<int>(role)) && (role < 3 || has(3) || has(4) || has(5)))
        fail(line.data(), "the header lacks a column", "no column " + std::string(kRoleNames[role]),
             "x,y,z, and nx,ny,nz together or not at all", "name the columns in the first line");
  }

  void take_column(const files::ColumnName& column, const char* place) {
    const std::string name = files::lower(column.name);
    const auto known = std::find(kRoleNames.begin(), kRoleNames.end(), name);
    int role = known != kRoleNames.end() ? static_cast<int>(known - kRoleNames.begin()) : column.role;
    if (name == "index" || name == "feed_mm_s") role = kPassedOver;
    double number = 0.0;
    if (role < 0 && files::parse_number(name.data(), name.data() + name.size(), true, number) != name.data())
      fail(place, "the contour file has no header", files::quoted(name), "a line x,y,z,nx,ny,nz,path,closed",
           "add it as the first line");
    if (role < 0)
      fail(place, "unknown column", files::quoted(column.name), "x,y,z,nx,ny,nz, and path, closed as needed",
           "correct the name, or leave the column out");
    if (role != kPassedOver && has(role))
      fail(place, "a column stands twice", files::quoted(column.name), "each column once",
           "leave one of them out");
    roles_.push_back(role);
  }

  void take_row(std::string_view line) {
    const auto cells = files::cells_of(line, separator_);
    if (cells.size() != roles_.size())
      fail(line.data(), "wrong number of fields", std::to_string(cells.size()),
           std::to_string(roles_.size()) + ", as the header has");
    Row row;
    row.value[kPath] = 1.0;
    row.place = line.data();
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (roles_[i] != kPassedOver)
        row.value[static_cast<std::size_t>(roles_[i])] = number(cells[i], roles_[i], row.place);
    if (contours_.empty() || row.path() != contours_.back().id) begin_contour(row);
    add(row);
  }

  double number(std::string_view cell, int role, const char* place) const {
    const std::string column(kRoleNames[static_cast<std::size_t>(role)]);
    const char* const end = cell.data() + cell.size();
    double value = 0.0;
    if (cell.empty() || files::parse_number(cell.data(), end, separator_ != ',', value) != end)
      fail(place, "not a number in column " + column, files::quoted(cell), "a number");
    if (!std::isfinite(value) || !std::isfinite(value * source_.to_mm))
      fail(place, "not a finite number in column " + column, files::quoted(cell), "a finite number");
    if (role == kPath && (value != std::floor(value) || std::abs(value) > 2e9))
      fail(place, "not a whole number in column path", files::quoted(cell), "a whole number");
    if (role == kClosed && value != 0.0 && value != 1.0)
      fail(place, "not a yes or no in column closed", files::quoted(cell), "0 or 1");
    return value;
  }

  void begin_contour(const Row& row) {
    finish_contour();
    if (!seen_.insert(row.path()).second)
      fail(row.place, "contour " + std::to_string(row.path()) + " is taken up again after another",
           "its rows in two places", "consecutive rows", "give the second part a number of its own");
    Contour contour;
    contour.id = row.path();
    contour.closed = row.closed();
    contour.source = "file";
    contours_.push_back(std::move(contour));
  }

  void add(const Row& row) {
    Contour& contour = contours_.back();
    last_ = row.place;
    if (row.closed() != contour.closed)
      fail(row.place, "column closed changes within contour " + std::to_string(contour.id),
           row.closed() ? "1" : "0", "one value a contour");
    contour.points_mm.push_back(row.point() * source_.to_mm);
    if (!has(3)) return;
    const double length = row.normal().norm();
    if (!(std::abs(length - 1.0) <= 0.01))
      fail(row.place, "the normal nx,ny,nz is no unit vector", "length " + std::to_string(length),
           "1 within 1 %");
    contour.normals.push_back(row.normal() / length);
  }

  void finish_contour() {
    if (contours_.empty()) return;
    Contour& contour = contours_.back();
    const bool repeats = contour.points_mm.size() > 1 &&
                         (contour.points_mm.back() - contour.points_mm.front()).norm() <= kRepeated_mm;
    if (!has(kClosed)) contour.closed = repeats;
    if (contour.closed && repeats) {
      contour.points_mm.pop_back();
      if (!contour.normals.empty()) contour.normals.pop_back();
    }
    const std::size_t needed = contour.closed ? 3 : 2;
    if (contour.points_mm.size() < needed)
      fail(last_, "contour " + std::to_string(contour.id) + " is too short",
           std::to_string(contour.points_mm.size()) + " points",
           std::to_string(needed) + (contour.closed ? " for a closed one" : " for an open one"),
           "export the contour again");
  }

  const Source& source_;
  std::vector<int> roles_;  // per column
  char separator_ = ',';
  std::vector<Contour> contours_;
  std::set<int> seen_;
  const char* last_ = nullptr;
};

void append(std::string& text, double value, int decimals) {
  if (!std::isfinite(value)) throw Error(Fault::kBug, "contours_csv: a number that is not finite");
  std::array<char, 400> digits;  // 309 of the largest double, sign, point, decimals
  const double shown = std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : value;  // never -0.000000
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), shown, std::chars_format::fixed, decimals);
  text.append(digits.data(), end.ptr);
  text += ',';
}

}  // namespace

std::vector<Contour> read_contours_csv(std::string_view bytes, const std::string& name, double to_mm) {
  const std::optional<std::string> copy = files::with_line_feeds(bytes);
  Source source;
  source.bytes = copy ? std::string_view(*copy) : bytes;
  source.name = name;
  source.to_mm = to_mm;
  return ContourReader(source).read();
}

std::vector<Contour> read_contours(const std::filesystem::path& file, double to_mm) {
  const files::MappedFile mapped(file);
  return read_contours_csv(mapped.bytes(), file.string(), to_mm);
}

std::string contours_csv(std::span<const Contour> contours, const std::string& title) {
  const bool normals = std::all_of(contours.begin(), contours.end(), [](const Contour& contour) {
    return contour.normals.size() == contour.points_mm.size();
  });
  std::string text = "# " + files::printable(title, 200) + "\n";
  text += normals ? "x,y,z,nx,ny,nz,path,closed\n" : "x,y,z,path,closed\n";
  for (std::size_t c = 0; c < contours.size(); ++c)
    for (std::size_t i = 0; i < contours[c].points_mm.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) append(text, contours[c].points_mm[i][axis], 6);
      for (int axis = 0; normals && axis < 3; ++axis) append(text, contours[c].normals[i][axis], 9);
      text += std::to_string(c + 1) + (contours[c].closed ? ",1\n" : ",0\n");
    }
  return text;
}

}  // namespace arris
