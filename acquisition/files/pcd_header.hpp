#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/files/binary_rows.hpp"
#include "acquisition/files/source.hpp"

namespace arris::files {

struct PcdField {
  std::string name;
  std::size_t size = 4;
  char type = 'F';  ///< F, I or U
  std::size_t count = 1;
  std::size_t offset = 0;  ///< bytes from the start of a row
  std::size_t column = 0;  ///< numbers before it in an ASCII row
};

struct PcdHeader {
  enum class Body { kAscii, kBinary, kCompressed };
  Body body = Body::kAscii;
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::size_t row_bytes = 0;
  std::size_t row_columns = 0;
  std::size_t body_at = 0;
  std::string unit_hint;
  std::vector<std::string> notes;

  /// Index of the single-valued field of that name, or -1.
  [[nodiscard]] int field_at(const std::string& name) const;
};

/// The scalar type of a field; refuses sizes that are none.
[[nodiscard]] Scalar scalar_of(const Source& source, const PcdField& field);

/// Reads the header of versions .5 to .7; refuses tables that disagree and counts that overflow.
[[nodiscard]] PcdHeader read_pcd_header(const Source& source);

}  // namespace arris::files
