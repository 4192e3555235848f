#include "acquisition/geometry/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#ifndef ARRIS_PARALLEL_JTHREAD
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace arris {
namespace {

int thread_count(int threads) {
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

void parallel_for(std::size_t count, std::size_t chunk, int threads,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t chunks = (count + chunk - 1) / chunk;
  std::vector<std::exception_ptr> failures(chunks);
  const auto run_chunk = [&](std::size_t c) {
    try {
      body(c * chunk, std::min(count, (c + 1) * chunk));
    } catch (...) {
      failures[c] = std::current_exception();
    }
  };
  const int workers =
      std::min<int>(thread_count(threads), static_cast<int>(std::min<std::size_t>(chunks, 1024)));
  if (workers <= 1) {
    for (std::size_t c = 0; c < chunks; ++c) run_chunk(c);
  } else {
#ifdef ARRIS_PARALLEL_JTHREAD
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> pool;
    for (int w = 0; w < workers; ++w)
      pool.emplace_back([&] {
        for (std::size_t c = next++; c < chunks; c = next++) run_chunk(c);
      });
#else
    tbb::task_arena arena(workers);
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, chunks, run_chunk); });
#endif
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace arris
