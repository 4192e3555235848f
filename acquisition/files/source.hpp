#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/types/error.hpp"

namespace arris::files {

/// What every format reader gets: the bytes of one file and how its numbers become mm.
struct Source {
  std::string_view bytes;
  std::string name;    ///< for messages
  double to_mm = 1.0;  ///< mm in one unit of the file
  bool wide =
      false;  ///< keep points in double, file coordinates (meshes), instead of float32 about an offset
};

/// What every format reader gives back. Points that are not finite are still in it, as NaN, until settle().
struct Loaded {
  Eigen::Vector3d offset_mm = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> near_mm;  ///< about offset_mm; empty when Source::wide
  std::vector<Eigen::Vector3d> wide_mm;  ///< file coordinates; empty unless Source::wide
  std::vector<Eigen::Vector3f> normals;  ///< empty, or one a point; zero where the file has none
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::size_t nonfinite = 0;  ///< points that are NaN, infinite or beyond kFarthest_mm
  std::string format;
  std::string unit_hint;
  std::vector<std::string> extra_names;  ///< columns beyond coordinates and normals
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t points() const { return near_mm.size() + wide_mm.size(); }
};

/// Error(kInput) about this file; `at` says where inside it ("line 7", "byte 5120") and may be empty.
[[nodiscard]] Error bad_file(const Source& source, const std::string& what, const std::string& at,
                             const std::string& found, const std::string& needed, const std::string& next);

/// The text as it may stand in a message: one line, printable, at most `longest` characters.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = 40);

/// The same, trimmed and between quotes.
[[nodiscard]] std::string quoted(std::string_view text, std::size_t longest = 40);

/// "line 7" for a place in the bytes; counts line ends, so only for messages. Empty for a place outside.
[[nodiscard]] std::string line_of(const Source& source, const char* place);

/// The unit that a comment names after the word unit ("length unit = meters", "units: inch"):
/// mm, cm, m, um, inch, ft, or empty.
[[nodiscard]] std::string unit_in(std::string_view comment);

/// The unit a bare word stands for ("millimetres", "mm"): as unit_in().
[[nodiscard]] std::string unit_of_word(std::string_view word);

/// a * b, or SIZE_MAX when that overflows: for checks against what a file holds.
[[nodiscard]] std::size_t saturated_product(std::size_t a, std::size_t b);

/// Text in lower case (ASCII).
[[nodiscard]] std::string lower(std::string_view text);

/// Text without blanks, tabs and carriage returns at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The words of a line, separated by blanks and tabs.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line);

/// Cuts the next line off the front of the text, without its end ("\n" or "\r\n").
[[nodiscard]] std::string_view take_line(std::string_view& text);

}  // namespace arris::files
