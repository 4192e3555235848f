#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "acquisition/files/binary_rows.hpp"
#include "acquisition/files/source.hpp"

namespace arris::files {

struct PlyProperty {
  std::string name;
  bool is_list = false;
  Scalar count_type = Scalar::kUint8;  ///< of a list
  Scalar type = Scalar::kFloat32;      ///< of the value, or of each item of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_list() const;
  /// Bytes of a row in a binary body when its lists are empty.
  [[nodiscard]] std::size_t least_row_bytes() const;
  /// Index of the first property of that name that is no list, or -1.
  [[nodiscard]] int scalar_at(const std::string& property) const;
};

struct PlyHeader {
  enum class Body { kAscii, kLittleEndian, kBigEndian };
  Body body = Body::kAscii;
  std::vector<PlyElement> elements;
  std::size_t body_at = 0;  ///< first byte after the line end of end_header; blanks there belong to the body
  std::string unit_hint;
  std::vector<std::string> notes;
};

/// Reads the header: LF, CRLF or CR line ends, blanks at line ends, comments anywhere, unknown elements.
[[nodiscard]] PlyHeader read_ply_header(const Source& source);

}  // namespace arris::files
