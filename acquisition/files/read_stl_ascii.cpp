#include <algorithm>
#include <cstring>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/number.hpp"
#include "acquisition/files/point_sink.hpp"
#include "acquisition/files/weld.hpp"

namespace arris::files {
namespace {

class StlText {
 public:
  explicit StlText(const Source& source)
      : source_(source),
        p_(source.bytes.data()),
        end_(p_ + source.bytes.size()),
        welder_(source.bytes.size() / 80) {}

  Loaded read() {
    out_.format = "stl ascii";
    skip_blanks();
    while (p_ < end_) {
      expect("solid");
      const std::string_view name = rest_of_line();
      if (out_.unit_hint.empty()) out_.unit_hint = unit_in(name);
      read_solid();
      ++solids_;
      skip_blanks();
    }
    if (solids_ > 1) out_.notes.push_back(std::to_string(solids_) + " solids, read as one mesh");
    const auto& points = welder_.points();
    store_rows(source_, points, {}, out_);
    return std::move(out_);
  }

 private:
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void skip_blanks() {
    while (p_ < end_ && is_blank(*p_)) ++p_;
  }

  std::string_view word() {
    skip_blanks();
    const char* const begin = p_;
    while (p_ < end_ && !is_blank(*p_)) ++p_;
    return {begin, static_cast<std::size_t>(p_ - begin)};
  }

  std::string_view rest_of_line() {
    const char* const begin = p_;
    while (p_ < end_ && *p_ != '\n' && *p_ != '\r') ++p_;
    return {begin, static_cast<std::size_t>(p_ - begin)};
  }

  static bool is(std::string_view found, std::string_view keyword) {
    return found == keyword || lower(found) == keyword;
  }

  void expect(std::string_view keyword) {
    const std::string_view found = word();
    if (!is(found, keyword)) throw unexpected(found, "'" + std::string(keyword) + "'");
  }

  Error unexpected(std::string_view found, const std::string& needed) const {
    if (found.empty())
      return bad_file(source_, "the STL file ends early", "",
                      std::to_string(out_.triangles.size()) + " triangles", needed + " before the end",
                      "export or copy the file again");
    return bad_file(source_, "the ASCII STL file breaks its grammar", line_of(source_, found.data()),
                    quoted(found), needed, "export the file again, as binary STL if possible");
  }

  void read_solid() {
    while (true) {
      const std::string_view keyword = word();
      if (is(keyword, "facet")) {
        read_facet();
      } else if (is(keyword, "endsolid")) {
        rest_of_line();
        return;
      } else {
        throw unexpected(keyword, "'facet' or 'endsolid'");
      }
    }
  }

  void read_facet() {
    expect("normal");
    for (int i = 0; i < 3; ++i)
      if (word().empty()) throw unexpected({}, "a facet normal");
    expect("outer");
    expect("loop");
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& corner : corners) {
      expect("vertex");
      for (int axis = 0; axis < 3; ++axis) corner[axis] = number();
    }
    expect("endloop");
    expect("endfacet");
    welder_.add(corners, out_.triangles.emplace_back().data());
  }

  double number() {
    const std::string_view found = word();
    double value = 0.0;
    const char* const end = found.data() + found.size();
    if (found.empty() || parse_number(found.data(), end, false, value) != end)
      throw unexpected(found, "a number");
    return value;
  }

  const Source& source_;
  const char* p_;
  const char* end_;
  Welder<double> welder_;
  Loaded out_;
  std::size_t solids_ = 0;
};

}  // namespace

Loaded read_stl_ascii(const Source& source) {
  return StlText(source).read();
}

}  // namespace arris::files
