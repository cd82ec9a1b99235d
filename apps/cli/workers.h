#pragma once
/// \file
/// Measurements that do not depend on one another, on several threads.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/cli/measurements.h"

namespace percale::cli {

struct Work {
  std::string name;
  int cost = 0;    ///< About as many calls of `goOn` as `measure` makes, times `weight`.
  int weight = 1;  ///< What one of them counts.
  std::function<std::optional<Course>(const std::function<bool()>& goOn)> measure;
};

struct FinishedWork {
  std::string name;
  Course course;
};

class Workers {
 public:
  /// Starts at once. What costs most goes first, so that the threads end together.
  Workers(std::vector<Work> works, int threads);
  ~Workers();  ///< Breaks off what is not finished.
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Waits for the next that is finished, but not longer than `patience`. Throws what a measurement threw.
  std::optional<FinishedWork> Next(std::chrono::milliseconds patience);
  /// All works are finished and taken, or broken off.
  bool Done();

  int cost() const { return cost_; }          ///< Of all works.
  int progress() const { return progress_; }  ///< Up to cost().

 private:
  void Run();

  std::vector<Work> works_;
  int cost_ = 0;
  std::atomic<std::size_t> next_{0};
  std::atomic<int> progress_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<FinishedWork> finished_;  // under mutex_, as are the following
  std::exception_ptr failure_;
  std::size_t running_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace percale::cli
