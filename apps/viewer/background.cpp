#include "apps/viewer/background.h"

#include <exception>
#include <utility>

namespace percale::viewer {

Background::Background(std::function<void()> wake) : wake_(std::move(wake)), thread_([this] { Loop(); }) {}

Background::~Background() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Background::Do(std::function<JobReport()> job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

std::vector<JobReport> Background::TakeReports() {
  const std::lock_guard lock(mutex_);
  return std::exchange(reports_, {});
}

void Background::Finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty() && !busy_; });
}

void Background::Loop() {
  for (;;) {
    std::function<JobReport()> job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
      if (jobs_.empty()) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
      busy_ = true;
    }
    JobReport report;
    try {
      report = job();
    } catch (const std::exception& error) {  // No memory.
      report = {"file", {}, {MakeError(std::string("nothing was saved: ") + error.what())}};
    }
    {
      const std::lock_guard lock(mutex_);
      busy_ = false;
      reports_.push_back(std::move(report));
    }
    changed_.notify_all();
    if (wake_) wake_();
  }
}

}  // namespace percale::viewer
