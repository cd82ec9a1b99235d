#include "core/executor.h"

#include <algorithm>
#include <thread>

#if defined(PERCALE_PARALLEL_TBB)
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#elif defined(PERCALE_PARALLEL_STD)
#include <atomic>
#include <vector>
#endif

namespace percale {

#if defined(PERCALE_PARALLEL_TBB)
struct Executor::Backend {
  explicit Backend(int threads)
      : control(tbb::global_control::max_allowed_parallelism,
                std::max(static_cast<std::size_t>(threads),
                         tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism))),
        arena(threads) {}
  tbb::global_control control;  // TBB warns of arenas larger than the machine unless they are allowed
  tbb::task_arena arena;
};
#else
struct Executor::Backend {
  explicit Backend(int) {}
};
#endif

Executor::Executor(int threads) {
#if defined(PERCALE_PARALLEL_TBB) || defined(PERCALE_PARALLEL_STD)
  threads_ = threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
#else
  static_cast<void>(threads);
  threads_ = 1;
#endif
  if (threads_ > 1) backend_ = std::make_unique<Backend>(threads_);
}

Executor::~Executor() = default;

void Executor::Run(int chunks, ChunkFunction function, void* context) const {
#if defined(PERCALE_PARALLEL_TBB)
  backend_->arena.execute([&] {
    tbb::parallel_for(
        0, chunks, [&](int chunk) { function(context, chunk); }, tbb::simple_partitioner());
  });
#elif defined(PERCALE_PARALLEL_STD)
  // Plain threads, slow to start but transparent to the thread sanitizer.
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int chunk = next++; chunk < chunks; chunk = next++) function(context, chunk);
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < std::min(threads_, chunks); ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
#else
  for (int chunk = 0; chunk < chunks; ++chunk) function(context, chunk);
#endif
}

}  // namespace percale
