#include "report/deviation_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "report/number_text.hpp"

namespace arris::report {
namespace {

/// A row of the file while it is filled.
struct Row {
  std::array<char, 31> bytes;
  std::size_t size = 0;
  void add(std::uint8_t byte) { bytes[size++] = static_cast<char>(byte); }
  void add(float value) { add_little_endian(std::bit_cast<std::uint32_t>(value)); }
  void add(double value) { add_little_endian(std::bit_cast<std::uint64_t>(value)); }

 private:
  template <class Word>
  void add_little_endian(Word word) {
    for (std::size_t i = 0; i < sizeof(Word); ++i)
      bytes[size++] = static_cast<char>((word >> (8 * i)) & 0xFFU);
  }
};

// A comment is one line of printable ASCII, whatever came in.
std::string comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "comment " + text + "\n";
}

bool is_wide(const DeviationRows& rows) {
  return !rows.cloud.offset_mm.isZero(0.0);
}

}  // namespace

std::string deviation_header(const DeviationRows& rows) {
  const std::string type = is_wide(rows) ? "double" : "float";
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& line : rows.comments) text += comment(line);
  text += comment("unit mm, scan frame, coordinates of the scan file");
  text += comment(
      "deviation_mm: shortest signed distance to the CAD after the rigid alignment; positive = outside "
      "the material; nan = no data");
  text += comment("colour scale: zone +-" + fixed_text(rows.colours.half_zone_mm(), 4) + " mm, ends at +-" +
                  fixed_text(rows.colours.limit_mm(), 4) + " mm");
  text += "element vertex " + std::to_string(rows.cloud.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + type + " " + axis + "\n";
  text += "property float deviation_mm\n";
  for (const char* channel : {"red", "green", "blue"})
    text += std::string("property uchar ") + channel + "\n";
  return text + "end_header\n";
}

std::size_t deviation_row_bytes(const DeviationRows& rows) {
  return is_wide(rows) ? 31 : 19;
}

void append_deviation_rows(const DeviationRows& rows, std::size_t begin, std::size_t end,
                           std::string& bytes) {
  const bool wide = is_wide(rows);
  bytes.reserve(bytes.size() + (end - begin) * deviation_row_bytes(rows));
  for (std::size_t i = begin; i < end; ++i) {
    Row row;
    const Eigen::Vector3d p = rows.cloud.file_mm(i);
    for (int axis = 0; axis < 3; ++axis) {
      if (wide)
        row.add(p[axis]);
      else
        row.add(rows.cloud.points_mm[i][axis]);
    }
    const bool known = i < rows.deviation_mm.size() && std::isfinite(rows.deviation_mm[i]);
    const double d = known ? rounded(rows.deviation_mm[i]) : std::numeric_limits<double>::quiet_NaN();
    row.add(known ? static_cast<float>(d) : std::numeric_limits<float>::quiet_NaN());
    const Rgb colour = rows.colours.colour(d);
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) row.add(part);
    bytes.append(row.bytes.data(), row.size);
  }
}

}  // namespace arris::report
