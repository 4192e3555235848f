#include <algorithm>
#include <cmath>

#include "acquisition/files/face_fan.hpp"
#include "acquisition/files/number.hpp"
#include "acquisition/files/ply_body.hpp"
#include "acquisition/files/text_rows.hpp"

namespace arris::files {
namespace {

class AsciiBody {
 public:
  AsciiBody(const Source& source, const PlyHeader& header, const PlyVertexPlan& plan, Loaded& out)
      : source_(source), plan_(plan), out_(out), rest_(source.bytes.substr(header.body_at)) {
    points_ = vertex_of(header)->count;
  }

  void load(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      if (element.properties.empty()) continue;
      if (saturated_product(element.count, 2 * element.properties.size()) > rest_.size() + 1)
        throw ply_ends_early(source_, element, rest_.size() / (2 * element.properties.size()));
      if (element.name == "vertex" && !vertex_done_)
        load_vertices(element);
      else if (corner_list_of(element) >= 0)
        load_faces(element, static_cast<std::size_t>(corner_list_of(element)));
      else
        for (std::size_t row = 0; row < element.count; ++row) static_cast<void>(row_of(element, row));
    }
    if (!trimmed_all(rest_).empty()) out_.notes.push_back("text after the last PLY element");
  }

 private:
  static std::string_view trimmed_all(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
  }

  /// The next line that is not blank.
  std::string_view row_of(const PlyElement& element, std::size_t row) {
    while (!rest_.empty()) {
      const std::string_view line = take_line(rest_);
      if (!trimmed(line).empty()) return line;
    }
    throw ply_ends_early(source_, element, row);
  }

  void load_vertices(const PlyElement& element) {
    vertex_done_ = true;
    RowLayout layout;
    layout.comments = false;
    std::size_t used = 0;
    bool list_first = false;
    for (std::size_t i = 0; i < element.properties.size(); ++i)
      if (plan_.role_of(i) >= 0) used = i + 1;
    for (std::size_t i = 0; i < used; ++i) {
      layout.roles.push_back(plan_.role_of(i));
      list_first = list_first || element.properties[i].is_list;
    }
    if (list_first) return load_listed_vertices(element);
    const std::string_view rows = take_rows(element);
    const std::size_t count = rows.empty() ? 0 : load_text_rows(source_, rows, layout, out_);
    if (count != element.count) throw ply_ends_early(source_, element, count);
  }

  /// The text of all rows of an element.
  std::string_view take_rows(const PlyElement& element) {
    const std::string_view before = rest_;
    for (std::size_t row = 0; row < element.count; ++row) static_cast<void>(row_of(element, row));
    return before.substr(0, before.size() - rest_.size());
  }

  /// Reads the numbers of one row; lists are handed to item(property, value) one by one, like scalars.
  template <class Item>
  void walk_row(const PlyElement& element, std::size_t row, const Item& item) {
    const std::string_view line = row_of(element, row);
    const char* p = line.data();
    const char* const end = p + line.size();
    const auto next = [&]() {
      while (p < end && (*p == ' ' || *p == '\t')) ++p;
      double value = 0.0;
      const char* const after = parse_number(p, end, false, value);
      if (after == p || (after < end && *after != ' ' && *after != '\t' && *after != '\r'))
        throw bad_file(source_, "a PLY row does not hold what the header announces",
                       line_of(source_, line.data()), quoted(line),
                       "a number for every property of " + printable(element.name),
                       "export or copy the file again");
      p = after;
      return value;
    };
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      double items = 1.0;
      if (element.properties[i].is_list) items = next();
      for (double k = 0; k < items; ++k) item(i, next());
    }
  }

  void load_listed_vertices(const PlyElement& element) {
    std::vector<Eigen::Vector3d> points(element.count);
    std::vector<Eigen::Vector3f> normals(plan_.with_normals() ? element.count : 0);
    for (std::size_t row = 0; row < element.count; ++row) {
      walk_row(element, row, [&](std::size_t property, double value) {
        const int role = plan_.role_of(property);
        if (role >= 3)
          normals[row][role - 3] = static_cast<float>(value);
        else if (role >= 0)
          points[row][role] = value;
      });
    }
    store_rows(source_, points, normals, out_);
  }

  void load_faces(const PlyElement& element, std::size_t corner_list) {
    FaceFan fan(source_, points_, out_);
    fan.expect(std::min(element.count, rest_.size() / 8));
    for (std::size_t row = 0; row < element.count; ++row) {
      walk_row(element, row, [&](std::size_t property, double value) {
        if (property != corner_list) return;
        const bool whole = value >= 0 && value < 9e15 && value == std::floor(value);
        fan.corner(whole ? static_cast<std::int64_t>(value) : -1);
      });
      fan.close();
    }
    fan.finish();
  }

  const Source& source_;
  const PlyVertexPlan& plan_;
  Loaded& out_;
  std::string_view rest_;
  bool vertex_done_ = false;
  std::size_t points_ = 0;
};

}  // namespace

void load_ply_ascii(const Source& source, const PlyHeader& header, const PlyVertexPlan& plan, Loaded& out) {
  AsciiBody(source, header, plan, out).load(header);
}

}  // namespace arris::files
