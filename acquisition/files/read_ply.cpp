#include <algorithm>

#include "acquisition/files/formats.hpp"
#include "acquisition/files/ply_body.hpp"

namespace arris::files {
namespace {

PlyVertexPlan plan_for(const Source& source, const PlyElement& vertex) {
  static constexpr const char* kNames[6][2] = {{"x", "X"},         {"y", "Y"},         {"z", "Z"},
                                               {"nx", "normal_x"}, {"ny", "normal_y"}, {"nz", "normal_z"}};
  PlyVertexPlan plan;
  for (std::size_t role = 0; role < 6; ++role)
    for (const char* name : kNames[role])
      if (plan.at[role] < 0) plan.at[role] = vertex.scalar_at(name);
  for (std::size_t role = 0; role < 3; ++role) {
    if (plan.at[role] >= 0) continue;
    throw bad_file(source, "the PLY vertices have no coordinates", "header",
                   std::string("no property ") + kNames[role][0], "scalar properties x, y and z",
                   "export the scan again with coordinates");
  }
  if (plan.at[3] < 0 || plan.at[4] < 0) plan.at[5] = -1;
  if (plan.at[5] < 0) plan.at[3] = plan.at[4] = -1;
  return plan;
}

const char* format_of(PlyHeader::Body body) {
  switch (body) {
    case PlyHeader::Body::kAscii:
      return "ply ascii";
    case PlyHeader::Body::kLittleEndian:
      return "ply binary little endian";
    case PlyHeader::Body::kBigEndian:
      break;
  }
  return "ply binary big endian";
}

}  // namespace

int PlyVertexPlan::role_of(std::size_t property) const {
  for (std::size_t role = 0; role < at.size(); ++role)
    if (at[role] == static_cast<int>(property)) return static_cast<int>(role);
  return -1;
}

const PlyElement* vertex_of(const PlyHeader& header) {
  const auto is_vertex = [](const PlyElement& element) { return element.name == "vertex"; };
  const auto found = std::find_if(header.elements.begin(), header.elements.end(), is_vertex);
  return found == header.elements.end() ? nullptr : &*found;
}

int corner_list_of(const PlyElement& element) {
  if (element.name != "face") return -1;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index"))
      return static_cast<int>(i);
  }
  return -1;
}

Error ply_ends_early(const Source& source, const PlyElement& element, std::size_t rows) {
  return bad_file(source, "the PLY file ends early", "element " + printable(element.name),
                  (rows < element.count ? "at most " + std::to_string(rows) : std::string("not all")) +
                      " of " + std::to_string(element.count) + " rows",
                  "all rows that the header announces", "export or copy the file again");
}

Loaded read_ply(const Source& source) {
  const PlyHeader header = read_ply_header(source);
  if (header.body == PlyHeader::Body::kAscii) {
    if (const auto copy = with_line_feeds(source.bytes)) {
      Source other = source;
      other.bytes = *copy;
      return read_ply(other);
    }
  }
  if (vertex_of(header) == nullptr)
    throw bad_file(source, "the PLY file has no vertices", "header",
                   std::to_string(header.elements.size()) + " elements, none named vertex",
                   "an element vertex", "export points or a mesh");
  const PlyElement& vertex = *vertex_of(header);
  const PlyVertexPlan plan = plan_for(source, vertex);
  Loaded out;
  out.format = format_of(header.body);
  out.unit_hint = header.unit_hint;
  out.notes = header.notes;
  for (std::size_t i = 0; i < vertex.properties.size(); ++i)
    if (plan.role_of(i) < 0) out.extra_names.push_back(vertex.properties[i].name);
  if (header.body == PlyHeader::Body::kAscii)
    load_ply_ascii(source, header, plan, out);
  else
    load_ply_binary(source, header, plan, out);
  return out;
}

}  // namespace arris::files
