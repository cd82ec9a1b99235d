#pragma once
/// \file
/// Progress on stderr: a bar for people, lines of JSON for programs.

#include <chrono>
#include <string>

#include "apps/cli/options.h"
#include "percale/world.h"

namespace percale::cli {

class Progress {
 public:
  /// `frames` is the most that will run, or the whole of what is counted otherwise. `what` stands
  /// before the bar: "simulate".
  Progress(ProgressKind kind, std::string what, int frames);
  ~Progress();  ///< Clears the bar.
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A frame is done. The first is shown at once, then at most ten a second.
  void Update(const StepReport& report);
  /// The last frame is done, however it came to be the last.
  void Finish(const StepReport& report);

  /// The same for what is no run of a single World.
  void Update(int done);
  void Finish(int done);

 private:
  using Clock = std::chrono::steady_clock;
  bool IsDue();
  double Elapsed() const;
  void ShowBar(int done);
  void ShowJson(const StepReport& report, bool last);
  void ShowJson(int done, bool last);

  ProgressKind kind_;
  std::string what_;
  int frames_;
  Clock::time_point start_, shown_;
  bool drawn_ = false;
};

}  // namespace percale::cli
