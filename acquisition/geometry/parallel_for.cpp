#include "acquisition/geometry/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#ifndef ARRIS_PARALLEL_JTHREAD
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// Never more than the machine has: TBB would print a warning, and nothing would be faster.
int thread_count(int threads) {
#ifdef ARRIS_PARALLEL_JTHREAD
  const int most = std::max(8, static_cast<int>(std::thread::hardware_concurrency()));  // races need company
#else
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const int most = std::clamp(static_cast<int>(allowed), 1, std::max(1, tbb::info::default_concurrency()));
#endif
  return threads > 0 ? std::min(threads, most) : most;
}

}  // namespace

void parallel_for(std::size_t count, std::size_t chunk, int threads,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (chunk == 0) throw Error(Fault::kBug, "parallel_for: chunk = 0, need >= 1");
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
