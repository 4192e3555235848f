#pragma once

#include <cstddef>
#include <functional>
#include <type_traits>
#include <vector>

namespace arris {

/// Calls body(begin, end) for consecutive chunks of [0, count), on up to `threads` threads (0: all of the
/// machine). Chunk borders depend on count and chunk alone, never on the thread count, so a body that writes
/// only its own range gives the same bytes for any number of threads. Every chunk runs, then the exception of
/// the lowest chunk that threw is thrown again. May be called inside a body: an inner call waits on its own
/// chunks only. Throws Error(kBug) when chunk is 0.
void parallel_for(std::size_t count, std::size_t chunk, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Sum of partial(begin, end) over the same chunks, added in chunk order: the same bits for any thread count.
/// T needs a default value that is zero (or `zero`) and operator+=.
template <class T, class Partial>
[[nodiscard]] T parallel_sum(std::size_t count, std::size_t chunk, int threads, T zero,
                             const Partial& partial) {
  static_assert(!std::is_same_v<T, bool>, "vector<bool> packs bits that chunks would share");
  const std::size_t chunks = chunk == 0 ? 0 : (count + chunk - 1) / chunk;
  std::vector<T> parts(chunks, zero);
  parallel_for(count, chunk, threads,
               [&](std::size_t begin, std::size_t end) { parts[begin / chunk] = partial(begin, end); });
  T sum = zero;
  for (const T& part : parts) sum += part;
  return sum;
}

}  // namespace arris
