#include "core/executor.h"

#include <doctest/doctest.h>

#include <atomic>
#include <vector>

namespace percale {
namespace {

TEST_CASE("Every chunk runs exactly once, for any number of threads and chunks") {
  for (const int threads : {1, 2, 3, 8}) {
    const Executor executor(threads);
    CHECK(executor.threads() >= 1);
    CHECK(executor.threads() <= threads);  // fewer in a build without threads
    for (const int chunks : {0, 1, 2, 7, 1000}) {
      std::vector<std::atomic<int>> runs(static_cast<std::size_t>(chunks));
      executor.ForChunks(chunks, [&](int chunk) { ++runs[static_cast<std::size_t>(chunk)]; });
      for (const auto& count : runs) CHECK(count == 1);
    }
  }
}

TEST_CASE("What chunks wrote is there when the loop returns") {
  const Executor executor(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<int> out(64, -1);
    executor.ForChunks(64, [&](int chunk) { out[static_cast<std::size_t>(chunk)] = chunk * chunk; });
    for (int k = 0; k < 64; ++k) REQUIRE(out[static_cast<std::size_t>(k)] == k * k);
  }
}

TEST_CASE("Without a number an executor takes as many threads as there are cores") {
  CHECK(Executor().threads() >= 1);
}

}  // namespace
}  // namespace percale
