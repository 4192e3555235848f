#include "acquisition/files/binary_rows.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "acquisition/geometry/parallel_for.hpp"

namespace arris::files {
namespace {

static_assert(std::endian::native == std::endian::little, "the readers take the machine as little endian");

constexpr std::size_t kChunkRows = 64 * RowBlock::kRows;

template <std::size_t size>
struct UnsignedOf;
template <>
struct UnsignedOf<1> {
  using Type = std::uint8_t;
};
template <>
struct UnsignedOf<2> {
  using Type = std::uint16_t;
};
template <>
struct UnsignedOf<4> {
  using Type = std::uint32_t;
};
template <>
struct UnsignedOf<8> {
  using Type = std::uint64_t;
};

inline std::uint8_t reversed(std::uint8_t v) {
  return v;
}
inline std::uint16_t reversed(std::uint16_t v) {
  return __builtin_bswap16(v);
}
inline std::uint32_t reversed(std::uint32_t v) {
  return __builtin_bswap32(v);
}
inline std::uint64_t reversed(std::uint64_t v) {
  return __builtin_bswap64(v);
}

template <class T>
inline T load(const char* p, bool swapped) {
  typename UnsignedOf<sizeof(T)>::Type bits;
  std::memcpy(&bits, p, sizeof bits);
  if (swapped) bits = reversed(bits);
  return std::bit_cast<T>(bits);
}

/// Calls use(T{}) with the type that the tag stands for.
template <class Use>
auto with_type(Scalar type, const Use& use) {
  switch (type) {
    case Scalar::kInt8:
      return use(std::int8_t{});
    case Scalar::kUint8:
      return use(std::uint8_t{});
    case Scalar::kInt16:
      return use(std::int16_t{});
    case Scalar::kUint16:
      return use(std::uint16_t{});
    case Scalar::kInt32:
      return use(std::int32_t{});
    case Scalar::kUint32:
      return use(std::uint32_t{});
    case Scalar::kInt64:
      return use(std::int64_t{});
    case Scalar::kUint64:
      return use(std::uint64_t{});
    case Scalar::kFloat32:
      return use(float{});
    case Scalar::kFloat64:
      break;
  }
  return use(double{});
}

/// Rows [begin, begin + count) of one column to out[0], out[3], out[6] ...
template <class Real>
void load_column(const Column& column, bool swapped, std::size_t begin, std::size_t count, Real* out) {
  const char* p = column.base + begin * column.stride;
  with_type(column.type, [&](auto zero) {
    using T = decltype(zero);
    if (swapped)
      for (std::size_t i = 0; i < count; ++i)
        out[3 * i] = static_cast<Real>(load<T>(p + i * column.stride, true));
    else
      for (std::size_t i = 0; i < count; ++i)
        out[3 * i] = static_cast<Real>(load<T>(p + i * column.stride, false));
  });
}

void load_block(const BinaryRows& rows, std::size_t begin, std::size_t count, RowBlock& block) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    load_column(rows.p[axis], rows.swapped, begin, count, block.p[0].data() + axis);
    if (rows.n) load_column((*rows.n)[axis], rows.swapped, begin, count, block.n[0].data() + axis);
  }
}

std::vector<Eigen::Vector3d> sample_of(const BinaryRows& rows) {
  std::vector<Eigen::Vector3d> sample;
  RowBlock block;
  for (std::size_t i = 0; i < rows.count; i += rows.count / 256 + 1) {
    load_block(rows, i, 1, block);
    sample.push_back(block.p[0]);
  }
  return sample;
}

}  // namespace

std::size_t size_of(Scalar type) {
  return with_type(type, [](auto zero) { return sizeof zero; });
}

double load_scalar(const char* p, Scalar type, bool swapped) {
  return with_type(type, [&](auto zero) { return static_cast<double>(load<decltype(zero)>(p, swapped)); });
}

void load_rows(const Source& source, const BinaryRows& rows, Loaded& out) {
  PointSink sink(source, rows.count, rows.n.has_value(), out);
  sink.choose_offset(sample_of(rows));
  parallel_for(rows.count, kChunkRows, 0, [&](std::size_t begin, std::size_t end) {
    RowBlock block;
    for (std::size_t at = begin; at < end; at += RowBlock::kRows) {
      const std::size_t count = std::min(RowBlock::kRows, end - at);
      load_block(rows, at, count, block);
      sink.store(at, block, count);
    }
  });
  sink.finish();
}

}  // namespace arris::files
