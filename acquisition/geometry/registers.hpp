#pragma once

#include <cstdint>

/// Vectors of GCC and Clang as wide as the registers of a CPU: kernels are written once for all widths and
/// chosen when the program runs.
namespace arris::registers {

template <int kBytes>
struct Of;
template <>
struct Of<16> {
  using Floats = float __attribute__((vector_size(16)));
  using Ints = std::int32_t __attribute__((vector_size(16)));
  using Doubles = double __attribute__((vector_size(16)));
  using Longs = std::int64_t __attribute__((vector_size(16)));
};
template <>
struct Of<32> {
  using Floats = float __attribute__((vector_size(32)));
  using Ints = std::int32_t __attribute__((vector_size(32)));
  using Doubles = double __attribute__((vector_size(32)));
  using Longs = std::int64_t __attribute__((vector_size(32)));
};
/// Whether the CPU has AVX2, and with it Of<32>. AVX-512 is left out: what GCC 12 makes of its masks is
/// slower.
[[nodiscard]] inline bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace arris::registers

// A function that takes the instructions of its caller must become part of it.
#define ARRIS_INLINE [[gnu::always_inline]] inline
