#pragma once
/// \file
/// A thread for what takes a while, such as writing files: the window goes on meanwhile.

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "percale/diagnostic.h"

namespace percale::viewer {

/// What came of a job.
struct JobReport {
  std::string what;            ///< "checkpoint", "picture", ...: what was to be saved.
  std::filesystem::path file;  ///< Where it is; empty: it failed.
  Diagnostics diagnostics;     ///< What the user is to be told.
};

class Background {
 public:
  /// `wake` is called on the thread when there is a report.
  explicit Background(std::function<void()> wake);
  ~Background();  ///< Does what waits, then ends the thread.
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Jobs are done one after the other, in order.
  void Do(std::function<JobReport()> job);
  /// Of the jobs that are done since the last call.
  std::vector<JobReport> TakeReports();
  /// Waits until nothing is left to do.
  void Finish();

 private:
  void Loop();

  std::function<void()> wake_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<JobReport()>> jobs_;
  std::vector<JobReport> reports_;
  bool busy_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace percale::viewer
