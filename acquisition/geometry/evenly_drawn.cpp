#include "acquisition/geometry/evenly_drawn.hpp"

#include <algorithm>
#include <cstdint>

namespace arris {
namespace {

/// SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): the same everywhere.
std::uint64_t scattered(std::uint64_t i) {
  i += 0x9E3779B97F4A7C15U;
  i = (i ^ (i >> 30U)) * 0xBF58476D1CE4E5B9U;
  i = (i ^ (i >> 27U)) * 0x94D049BB133111EBU;
  return i ^ (i >> 31U);
}

}  // namespace

std::vector<std::size_t> evenly_drawn(std::size_t size, std::size_t count) {
  std::vector<std::size_t> chosen(std::min(size, count));
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t begin = k * size / chosen.size(), end = (k + 1) * size / chosen.size();
    chosen[k] = begin + scattered(k) % (end - begin);
  }
  return chosen;
}

}  // namespace arris
