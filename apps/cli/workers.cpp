#include "apps/cli/workers.h"

#include <algorithm>

namespace percale::cli {

Workers::Workers(std::vector<Work> works, int threads) : works_(std::move(works)) {
  std::stable_sort(works_.begin(), works_.end(), [](const Work& a, const Work& b) { return a.cost > b.cost; });
  for (const Work& work : works_) cost_ += work.cost;
  const std::size_t count = std::min(works_.size(), std::size_t(std::max(1, threads)));
  running_ = count;  // the first may be done before the last has started
  for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { Run(); });
}

Workers::~Workers() {
  stop_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void Workers::Run() {
  for (std::size_t i = next_++; i < works_.size() && !stop_; i = next_++) {
    const Work& work = works_[i];
    try {
      auto course = work.measure([&] {
        progress_ += work.weight;
        return !stop_;
      });
      if (!course) continue;
      const std::lock_guard lock(mutex_);
      finished_.push_back({work.name, std::move(*course)});
    } catch (...) {
      stop_ = true;
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    changed_.notify_one();
  }
  const std::lock_guard lock(mutex_);
  --running_;
  changed_.notify_one();
}

std::optional<FinishedWork> Workers::Next(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return !finished_.empty() || failure_ || running_ == 0; });
  if (failure_) std::rethrow_exception(failure_);
  if (finished_.empty()) return std::nullopt;
  FinishedWork work = std::move(finished_.front());
  finished_.erase(finished_.begin());
  return work;
}

bool Workers::Done() {
  const std::lock_guard lock(mutex_);
  return running_ == 0 && finished_.empty() && !failure_;
}

}  // namespace percale::cli
