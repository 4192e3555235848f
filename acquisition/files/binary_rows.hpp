#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "acquisition/files/point_sink.hpp"

namespace arris::files {

/// The scalar types that PLY and PCD know.
enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };

[[nodiscard]] std::size_t size_of(Scalar type);

/// One value at p as a double; swapped: the file has the other byte order than this machine.
[[nodiscard]] double load_scalar(const char* p, Scalar type, bool swapped);

/// A column of numbers: row i is at base + i * stride.
struct Column {
  const char* base = nullptr;
  std::size_t stride = 0;
  Scalar type = Scalar::kFloat32;
};

/// Points at fixed places in a binary file; the caller has checked that all rows lie inside it.
struct BinaryRows {
  std::size_t count = 0;
  bool swapped = false;
  std::array<Column, 3> p;
  std::optional<std::array<Column, 3>> n;
};

/// Decodes all rows on all cores; the same bytes for any number of them.
void load_rows(const Source& source, const BinaryRows& rows, Loaded& out);

}  // namespace arris::files
