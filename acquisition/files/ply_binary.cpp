#include <algorithm>
#include <cmath>
#include <cstring>

#include "acquisition/files/face_fan.hpp"
#include "acquisition/files/ply_body.hpp"

namespace arris::files {
namespace {

class BinaryBody {
 public:
  BinaryBody(const Source& source, const PlyHeader& header, const PlyVertexPlan& plan, Loaded& out)
      : source_(source), plan_(plan), out_(out), swapped_(header.body == PlyHeader::Body::kBigEndian) {
    p_ = source.bytes.data() + header.body_at;
    end_ = source.bytes.data() + source.bytes.size();
    points_ = vertex_of(header)->count;
  }

  void load(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      const std::size_t least = element.least_row_bytes();
      if (least == 0) continue;
      if (saturated_product(element.count, least) > left())
        throw ply_ends_early(source_, element, left() / least);
      const bool is_vertex = element.name == "vertex" && !vertex_done_;
      if (is_vertex)
        load_vertices(element);
      else if (corner_list_of(element) >= 0)
        load_faces(element, static_cast<std::size_t>(corner_list_of(element)));
      else
        skip(element);
    }
    if (left() > 0) out_.notes.push_back(std::to_string(left()) + " bytes after the last PLY element");
  }

 private:
  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end_ - p_); }

  /// Steps over one property; `item(place)` sees the scalar or every item of the list.
  template <class Item>
  void walk(const PlyElement& element, const PlyProperty& property, std::size_t row, const Item& item) {
    const std::size_t size = size_of(property.type);
    std::size_t items = 1;
    if (property.is_list) {
      const std::size_t count_size = size_of(property.count_type);
      if (count_size > left()) throw ply_ends_early(source_, element, row);
      items = list_count(element, property, row);
      p_ += count_size;
    }
    if (saturated_product(items, size) > left()) throw ply_ends_early(source_, element, row);
    for (std::size_t i = 0; i < items; ++i, p_ += size) item(p_);
  }

  std::size_t list_count(const PlyElement& element, const PlyProperty& property, std::size_t row) const {
    if (property.count_type == Scalar::kUint8) return static_cast<unsigned char>(*p_);
    const double count = load_scalar(p_, property.count_type, swapped_);
    if (count < 0)
      throw bad_file(source_, "a PLY list has a negative length",
                     "element " + printable(element.name) + ", row " + std::to_string(row + 1),
                     std::to_string(static_cast<long long>(count)), "0 or more", "export the file again");
    return static_cast<std::size_t>(count);
  }

  void skip(const PlyElement& element) {
    if (!element.has_list()) {
      p_ += element.count * element.least_row_bytes();
      return;
    }
    for (std::size_t row = 0; row < element.count; ++row)
      for (const PlyProperty& property : element.properties) walk(element, property, row, [](const char*) {});
  }

  void load_vertices(const PlyElement& element) {
    vertex_done_ = true;
    if (element.has_list()) return load_listed_vertices(element);
    BinaryRows rows;
    rows.count = element.count;
    rows.swapped = swapped_;
    if (plan_.with_normals()) rows.n.emplace();
    std::size_t offset = 0;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Scalar type = element.properties[i].type;
      const int role = plan_.role_of(i);
      if (role >= 0) {
        const auto axis = static_cast<std::size_t>(role % 3);
        (role < 3 ? rows.p : *rows.n)[axis] = {p_ + offset, element.least_row_bytes(), type};
      }
      offset += size_of(type);
    }
    load_rows(source_, rows, out_);
    p_ += element.count * element.least_row_bytes();
  }

  /// Lists on the vertex: rows have different lengths, so they are walked one by one.
  void load_listed_vertices(const PlyElement& element) {
    std::vector<Eigen::Vector3d> points(element.count);
    std::vector<Eigen::Vector3f> normals(plan_.with_normals() ? element.count : 0);
    for (std::size_t row = 0; row < element.count; ++row) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const int role = plan_.role_of(i);
        walk(element, property, row, [&](const char* place) {
          if (role < 0) return;
          const double value = load_scalar(place, property.type, swapped_);
          if (role < 3)
            points[row][role] = value;
          else
            normals[row][role - 3] = static_cast<float>(value);
        });
      }
    }
    store_rows(source_, points, normals, out_);
  }

  void load_faces(const PlyElement& element, std::size_t corner_list) {
    FaceFan fan(source_, points_, out_);
    fan.expect(std::min(element.count, left() / (element.least_row_bytes() +
                                                 3 * size_of(element.properties[corner_list].type))));
    const PlyProperty& corners = element.properties[corner_list];
    const bool plain = (corners.type == Scalar::kInt32 || corners.type == Scalar::kUint32) && !swapped_;
    for (std::size_t row = 0; row < element.count; ++row) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (i != corner_list)
          walk(element, property, row, [](const char*) {});
        else if (plain)
          walk(element, property, row,
               [&](const char* place) { fan.corner(plain_index(place, corners.type)); });
        else
          walk(element, property, row, [&](const char* place) { fan.corner(index(place, corners.type)); });
      }
      fan.close();
    }
    fan.finish();
  }

  static std::int64_t plain_index(const char* place, Scalar type) {
    std::uint32_t bits;
    std::memcpy(&bits, place, sizeof bits);
    return type == Scalar::kUint32 ? static_cast<std::int64_t>(bits) : static_cast<std::int32_t>(bits);
  }

  /// Anything that is no whole number becomes -1, which no point has.
  std::int64_t index(const char* place, Scalar type) const {
    const double value = load_scalar(place, type, swapped_);
    const bool whole = value >= 0 && value < 9e15 && value == std::floor(value);
    return whole ? static_cast<std::int64_t>(value) : -1;
  }

  const Source& source_;
  const PlyVertexPlan& plan_;
  Loaded& out_;
  bool swapped_;
  bool vertex_done_ = false;
  std::size_t points_ = 0;
  const char* p_ = nullptr;
  const char* end_ = nullptr;
};

}  // namespace

void load_ply_binary(const Source& source, const PlyHeader& header, const PlyVertexPlan& plan, Loaded& out) {
  BinaryBody(source, header, plan, out).load(header);
}

}  // namespace arris::files
