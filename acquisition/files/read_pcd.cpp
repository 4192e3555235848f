#include <algorithm>
#include <cstring>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/lzf.hpp"
#include "acquisition/files/pcd_header.hpp"
#include "acquisition/files/text_rows.hpp"

namespace arris::files {
namespace {

/// Fields of x y z nx ny nz; the last three -1 when the normal is not whole.
std::array<int, 6> used_fields(const Source& source, const PcdHeader& header) {
  static constexpr const char* kNames[6][2] = {{"x", "X"},         {"y", "Y"},         {"z", "Z"},
                                               {"normal_x", "nx"}, {"normal_y", "ny"}, {"normal_z", "nz"}};
  std::array<int, 6> used{};
  for (std::size_t role = 0; role < 6; ++role) {
    used[role] = header.field_at(kNames[role][0]);
    if (used[role] < 0) used[role] = header.field_at(kNames[role][1]);
    if (role < 3 && used[role] < 0)
      throw bad_file(source, "the PCD file has no coordinates", "header",
                     std::string("no single-valued field ") + kNames[role][0], "fields x, y and z",
                     "export the points, not only features or colours");
  }
  if (used[3] < 0 || used[4] < 0 || used[5] < 0) used[3] = used[4] = used[5] = -1;
  return used;
}

Error ends_early(const Source& source, const std::string& found, const std::string& needed) {
  return bad_file(source, "the PCD file ends early", "", found, needed, "export or copy the file again");
}

void load_ascii(const Source& source, const PcdHeader& header, const std::array<int, 6>& used, Loaded& out) {
  RowLayout layout;
  for (std::size_t role = 0; role < 6; ++role) {
    if (used[role] < 0) continue;
    const std::size_t column = header.fields[static_cast<std::size_t>(used[role])].column;
    if (layout.roles.size() <= column) layout.roles.resize(column + 1, -1);
    layout.roles[column] = static_cast<int>(role);
  }
  const std::string_view rows = source.bytes.substr(header.body_at);
  const std::size_t points = load_text_rows(source, rows, layout, out);
  if (points < header.points)
    throw ends_early(source, std::to_string(points) + " points",
                     std::to_string(header.points) + ", as its header says");
  if (points > header.points)
    throw bad_file(source, "the PCD file has more points than it says", "",
                   std::to_string(points) + " points", std::to_string(header.points) + ", as its header says",
                   "export the file again");
}

/// Rows in a body of records (stride: a whole row) or, compressed, of whole columns one after the other.
void load_body(const Source& source, const PcdHeader& header, const std::array<int, 6>& used,
               std::string_view body, bool by_column, Loaded& out) {
  BinaryRows rows;
  rows.count = header.points;
  if (used[3] >= 0) rows.n.emplace();
  for (std::size_t role = 0; role < 6; ++role) {
    if (used[role] < 0) continue;
    const PcdField& field = header.fields[static_cast<std::size_t>(used[role])];
    Column column;
    column.type = scalar_of(source, field);
    column.base = body.data() + (by_column ? field.offset * header.points : field.offset);
    column.stride = by_column ? field.size : header.row_bytes;
    (role < 3 ? rows.p : *rows.n)[role % 3] = column;
  }
  load_rows(source, rows, out);
}

void load_binary(const Source& source, const PcdHeader& header, const std::array<int, 6>& used, Loaded& out) {
  const std::string_view body = source.bytes.substr(header.body_at);
  const std::size_t needed = saturated_product(header.points, header.row_bytes);
  if (needed > body.size())
    throw ends_early(
        source, std::to_string(body.size()) + " bytes of data",
        std::to_string(header.points) + " points of " + std::to_string(header.row_bytes) + " bytes");
  if (body.size() > needed)
    out.notes.push_back(std::to_string(body.size() - needed) + " bytes after the last point");
  load_body(source, header, used, body, false, out);
}

void load_compressed(const Source& source, const PcdHeader& header, const std::array<int, 6>& used,
                     Loaded& out) {
  const std::string_view body = source.bytes.substr(header.body_at);
  if (body.size() < 8)
    throw ends_early(source, std::to_string(body.size()) + " bytes of data", "8 bytes of sizes");
  std::uint32_t packed_size = 0;
  std::uint32_t size = 0;
  std::memcpy(&packed_size, body.data(), 4);
  std::memcpy(&size, body.data() + 4, 4);
  if (packed_size > body.size() - 8)
    throw ends_early(source, std::to_string(body.size() - 8) + " bytes of compressed data",
                     std::to_string(packed_size));
  const std::size_t needed = saturated_product(header.points, header.row_bytes);
  if (size != needed || size > saturated_product(packed_size, kLzfGrowth))
    throw bad_file(
        source, "the compressed PCD data have another size than the header says", "",
        std::to_string(size) + " bytes from " + std::to_string(packed_size) + " packed ones",
        std::to_string(header.points) + " points of " + std::to_string(header.row_bytes) + " bytes",
        "export the file again");
  std::vector<char> columns(size);
  if (!unpack_lzf(body.substr(8, packed_size), columns))
    throw bad_file(source, "the compressed PCD data are damaged", "", "a broken LZF stream",
                   std::to_string(size) + " bytes from " + std::to_string(packed_size),
                   "export or copy the file again");
  load_body(source, header, used, {columns.data(), columns.size()}, true, out);
}

}  // namespace

Loaded read_pcd(const Source& source) {
  const PcdHeader header = read_pcd_header(source);
  const std::array<int, 6> used = used_fields(source, header);
  Loaded out;
  out.unit_hint = header.unit_hint;
  out.notes = header.notes;
  for (std::size_t i = 0; i < header.fields.size(); ++i)
    if (std::find(used.begin(), used.end(), static_cast<int>(i)) == used.end() &&
        header.fields[i].name != "_")
      out.extra_names.push_back(header.fields[i].name);
  switch (header.body) {
    case PcdHeader::Body::kAscii:
      out.format = "pcd ascii";
      load_ascii(source, header, used, out);
      break;
    case PcdHeader::Body::kBinary:
      out.format = "pcd binary";
      load_binary(source, header, used, out);
      break;
    case PcdHeader::Body::kCompressed:
      out.format = "pcd binary compressed";
      load_compressed(source, header, used, out);
      break;
  }
  return out;
}

}  // namespace arris::files
