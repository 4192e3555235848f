#include <algorithm>
#include <charconv>

#include "acquisition/files/face_fan.hpp"
#include "acquisition/files/formats.hpp"
#include "acquisition/files/number.hpp"
#include "acquisition/files/point_sink.hpp"

namespace arris::files {
namespace {

class OffText {
 public:
  explicit OffText(const Source& source) : source_(source), rest_(source.bytes) {}

  Loaded read() {
    read_header();
    read_vertices();
    FaceFan fan(source_, points_, out_);
    fan.expect(std::min(faces_, rest_.size() / 8));
    for (std::size_t i = 0; i < faces_; ++i) read_face(fan);
    fan.finish();
    return std::move(out_);
  }

 private:
  /// The next line that holds anything but a comment; empty at the end of the file.
  std::string_view statement() {
    while (!rest_.empty()) {
      std::string_view line = take_line(rest_);
      const std::size_t comment = line.find('#');
      if (comment != std::string_view::npos) {
        if (out_.unit_hint.empty()) out_.unit_hint = unit_in(line.substr(comment));
        line = line.substr(0, comment);
      }
      line = trimmed(line);
      if (!line.empty()) return line;
    }
    return {};
  }

  Error bad(const std::string& what, std::string_view line, const std::string& needed) const {
    return bad_file(source_, what, line_of(source_, line.data()), quoted(line), needed,
                    "export the mesh again");
  }

  Error ends_early(const char* part, std::size_t found, std::size_t needed) const {
    return bad_file(source_, "the OFF file ends early", "", std::to_string(found) + " " + part,
                    std::to_string(needed), "export or copy the file again");
  }

  void read_header() {
    std::string_view line = statement();
    if (line.empty()) throw ends_early("lines that are no comments", 0, 1);
    const std::string_view keyword = line.substr(0, line.find_first_of(" \t"));
    normals_ = keyword == "NOFF" || keyword == "CNOFF" || keyword == "NCOFF";
    if (!normals_ && keyword != "OFF" && keyword != "COFF")
      throw bad("this kind of OFF file is not read", line, "OFF, COFF or NOFF");
    out_.format = "off ascii";
    std::string_view counts = trimmed(line.substr(keyword.size()));
    if (counts.empty()) counts = statement();
    if (counts.empty()) throw ends_early("lines of counts", 0, 1);
    if (lower(counts).find("binary") != std::string::npos)
      throw bad("binary OFF files are not read", counts, "an ASCII OFF file");
    const auto words = words_of(counts);
    if (words.size() < 2 || !whole(words[0], points_) || !whole(words[1], faces_))
      throw bad("the OFF counts cannot be read", counts, "numbers of vertices, faces and edges");
    if (saturated_product(points_, 6) > source_.bytes.size())
      throw ends_early("vertices at most", source_.bytes.size() / 6, points_);
    if (saturated_product(faces_, 2) > source_.bytes.size())
      throw ends_early("faces at most", source_.bytes.size() / 2, faces_);
  }

  static bool whole(std::string_view word, std::size_t& value) {
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    return result.ec == std::errc() && result.ptr == word.data() + word.size();
  }

  void read_vertices() {
    std::vector<Eigen::Vector3d> points(points_);
    std::vector<Eigen::Vector3f> normals(normals_ ? points_ : 0);
    for (std::size_t i = 0; i < points_; ++i) {
      const std::string_view line = statement();
      if (line.empty()) throw ends_early("vertices", i, points_);
      const char* p = line.data();
      for (int axis = 0; axis < 3; ++axis) points[i][axis] = number(p, line);
      for (int axis = 0; normals_ && axis < 3; ++axis) normals[i][axis] = static_cast<float>(number(p, line));
    }
    store_rows(source_, points, normals, out_);
  }

  void read_face(FaceFan& fan) {
    const std::string_view line = statement();
    if (line.empty()) throw ends_early("faces", out_.triangles.size(), faces_);
    const char* p = line.data();
    const double corners = number(p, line);
    for (double k = 0; k < corners; ++k) {
      const double index = number(p, line);
      fan.corner(index >= 0 && index < 9e15 ? static_cast<std::int64_t>(index) : -1);
    }
    fan.close();
  }

  double number(const char*& p, std::string_view line) const {
    const char* const end = line.data() + line.size();
    while (p < end && (*p == ' ' || *p == '\t')) ++p;
    double value = 0.0;
    const char* const next = parse_number(p, end, false, value);
    if (next == p || (next < end && *next != ' ' && *next != '\t'))
      throw bad("an OFF row is not a row of numbers", line, "coordinates, or a count and indices");
    p = next;
    return value;
  }

  const Source& source_;
  std::string_view rest_;
  Loaded out_;
  bool normals_ = false;
  std::size_t points_ = 0;
  std::size_t faces_ = 0;
};

}  // namespace

Loaded read_off(const Source& source) {
  if (const auto copy = with_line_feeds(source.bytes)) {
    Source other = source;
    other.bytes = *copy;
    return OffText(other).read();
  }
  return OffText(source).read();
}

}  // namespace arris::files
