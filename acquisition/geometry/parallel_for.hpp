#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace arris {

/// Calls body(begin, end) for consecutive chunks of [0, count), on up to `threads` threads (0: all of the
/// machine). Chunk borders depend on count and chunk alone, never on the thread count, so a body that writes
/// only its own range gives the same bytes for any number of threads. The first exception of the lowest chunk
/// is thrown again.
void parallel_for(std::size_t count, std::size_t chunk, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Sum of partial(begin, end) over the same chunks, added in chunk order: the same bits for any thread count.
/// T needs a default value that is zero (or `zero`) and operator+=.
template <class T, class Partial>
[[nodiscard]] T parallel_sum(std::size_t count, std::size_t chunk, int threads, T zero,
                             const Partial& partial) {
  const std::size_t chunks = count == 0 ? 0 : (count + chunk - 1) / chunk;
  std::vector<T> parts(chunks, zero);
  parallel_for(count, chunk, threads,
               [&](std::size_t begin, std::size_t end) { parts[begin / chunk] = partial(begin, end); });
  T sum = zero;
  for (const T& part : parts) sum += part;
  return sum;
}

}  // namespace arris
