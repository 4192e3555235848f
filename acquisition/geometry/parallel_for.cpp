#include "acquisition/geometry/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#ifndef ARRIS_PARALLEL_JTHREAD
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#endif

#include "acquisition/types/error.hpp"

namespace arris {
namespace {

// Calls loop() `workers` times, at once where threads are free. TBB's own pool, without an arena of our own
// (an arena costs 100 us a call); isolated, so that a worker that waits here does not pick up a chunk of an
// outer call.
void run_workers(int workers, const std::function<void()>& loop) {
#ifdef ARRIS_PARALLEL_JTHREAD
  std::vector<std::jthread> pool;
  for (int w = 0; w < workers; ++w) pool.emplace_back(loop);
#else
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(
        0, workers, [&](int) { loop(); }, tbb::simple_partitioner());
  });
#endif
}

int thread_count(int threads) {
  if (threads > 0) return threads;
#ifdef ARRIS_PARALLEL_JTHREAD
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
#else
  return std::max(1, tbb::info::default_concurrency());
#endif
}

}  // namespace

void parallel_for(std::size_t count, std::size_t chunk, int threads,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  if (chunk == 0) throw Error(Fault::kBug, "parallel_for: chunk = 0, need >= 1");
  if (count == 0) return;
  const std::size_t chunks = (count - 1) / chunk + 1;
  std::vector<std::exception_ptr> failures(chunks);
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (std::size_t c = next++; c < chunks; c = next++) try {
        body(c * chunk, std::min(count, c * chunk + chunk));
      } catch (...) {
        failures[c] = std::current_exception();
      }
  };
  const int workers = static_cast<int>(std::min<std::size_t>(chunks, thread_count(threads)));
  if (workers == 1)
    loop();
  else
    run_workers(workers, loop);
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace arris
