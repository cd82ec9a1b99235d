#pragma once
/// \file
/// Records what the window shows, in real time: a film of 30 pictures per second of wall-clock time. It
/// encodes on a thread of its own and never keeps the window waiting.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "apps/viewer/background.h"
#include "render/image.h"

namespace percale::viewer {

class Recorder {
 public:
  static constexpr double kPicturesPerSecond = 30;
  /// So many pictures may wait for the encoder; a further one is dropped, and the one before stays in the film.
  static constexpr std::size_t kMostWaiting = 8;

  /// A film to STEM-1.mp4, STEM-2.mp4, ...: the first name that is free. `wake` is called, on the thread,
  /// when there is a report.
  Recorder(std::filesystem::path stem, double now, std::function<void()> wake);
  ~Recorder();  ///< As Stop; waits for the end.
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Whether the next picture is due. `now` counts seconds, here and in the following.
  bool Wants(double now) const { return !stopped_ && Slot(now) >= nextSlot_; }
  /// The picture that is shown from now on. All must be of the first one's size.
  void Add(Image image, double now);
  int width() const { return width_; }  ///< [pixel]; 0 before the first picture.
  int height() const { return height_; }

  /// Ends the film, of which the last picture lasts until now. The rest is done on the thread.
  void Stop(double now);
  bool stopped() const { return stopped_; }
  double seconds(double now) const { return now - start_; }
  /// The file is in its place, or has failed. Then nothing is left but the reports.
  bool ended() const { return ended_; }
  std::vector<JobReport> TakeReports();

 private:
  struct Shown {
    Image image;
    long slot = 0;  // In pictures since the start.
  };
  long Slot(double now) const { return static_cast<long>((now - start_) * kPicturesPerSecond); }
  void Loop();
  JobReport Encode();
  void Report(JobReport report);

  const std::filesystem::path stem_;
  const double start_;
  const std::function<void()> wake_;

  // The window's thread only.
  long nextSlot_ = 0;
  int width_ = 0, height_ = 0;
  bool stopped_ = false;

  // Shared.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Shown> waiting_;
  bool stop_ = false;
  long endSlot_ = 0;
  int dropped_ = 0;
  std::vector<JobReport> reports_;
  std::atomic<bool> ended_{false};

  std::thread thread_;
};

}  // namespace percale::viewer
