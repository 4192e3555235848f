#include "report/write_deviation_ply.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "report/colour_map.hpp"
#include "report/number_text.hpp"

namespace arris::report {
namespace {

template <class Word>
void append_little_endian(std::string& bytes, Word word) {
  for (std::size_t i = 0; i < sizeof(Word); ++i) bytes += static_cast<char>((word >> (8 * i)) & 0xFFU);
}
void append(std::string& bytes, float value) {
  append_little_endian(bytes, std::bit_cast<std::uint32_t>(value));
}
void append(std::string& bytes, double value) {
  append_little_endian(bytes, std::bit_cast<std::uint64_t>(value));
}

// A comment is one line of printable ASCII, whatever came in.
std::string comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "comment " + text + "\n";
}

std::string header(const RunRecord& record, bool wide, const ColourMap& map) {
  const std::string type = wide ? "double" : "float";
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text += comment(record.version + ", part " + record.part_number);
  text += comment("result_hash " + record.result_hash);
  text += comment("unit mm, scan frame, coordinates of the scan file");
  text += comment(
      "deviation_mm: shortest signed distance to the CAD after the rigid alignment; positive = outside "
      "the material; nan = no data");
  text += comment("colour scale: zone +-" + fixed_text(map.half_zone_mm(), 4) + " mm, ends at +-" +
                  fixed_text(map.limit_mm(), 4) + " mm");
  text += "element vertex " + std::to_string(record.cloud.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + type + " " + axis + "\n";
  text += "property float deviation_mm\n";
  for (const char* channel : {"red", "green", "blue"})
    text += std::string("property uchar ") + channel + "\n";
  return text + "end_header\n";
}

}  // namespace

std::string write_deviation_ply(const RunRecord& record) {
  const bool wide = !record.cloud.offset_mm.isZero(0.0);
  const ColourMap map = colour_map_for(record.deviation_mm, record.surface_profile_mm);
  std::string bytes = header(record, wide, map);
  bytes.reserve(bytes.size() + record.cloud.size() * (wide ? 31 : 19));
  for (std::size_t i = 0; i < record.cloud.size(); ++i) {
    const Eigen::Vector3d p = record.cloud.file_mm(i);
    for (int axis = 0; axis < 3; ++axis) {
      if (wide)
        append(bytes, p[axis]);
      else
        append(bytes, record.cloud.points_mm[i][axis]);
    }
    const bool known = i < record.deviation_mm.size() && std::isfinite(record.deviation_mm[i]);
    const double d = known ? rounded(record.deviation_mm[i]) : std::numeric_limits<double>::quiet_NaN();
    append(bytes, known ? static_cast<float>(d) : std::numeric_limits<float>::quiet_NaN());
    const Rgb colour = map.colour(d);
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) bytes += static_cast<char>(part);
  }
  return bytes;
}

}  // namespace arris::report
