#pragma once
/// \file
/// The simulation as the window plays it. Each command goes into the session log; and what was sent counts as done
/// already, so that a key that is pressed twice in a row means what the user sees, however long a frame takes.

#include <cstdint>
#include <string>
#include <vector>

#include "apps/viewer/session_log.h"
#include "apps/viewer/simulation.h"

namespace percale::viewer {

class Playback {
 public:
  /// `log` must outlive it.
  Playback(Scene scene, SimulationOptions options, SessionLog& log);

  /// Takes the newest state, and logs what was carried out. Returns false when there is none since the last call.
  bool Update();
  const Snapshot& snapshot() const { return snapshot_; }  ///< The newest state.
  /// See Simulation::WantContacts.
  void WantContacts(bool wanted) { simulation_.WantContacts(wanted); }
  /// See Simulation::TakeFailure.
  std::string TakeFailure() { return simulation_.TakeFailure(); }

  /// Sends a command, and logs it in a line of its own. Returns its number.
  std::uint64_t Send(Command command);
  /// The same with other lines.
  std::uint64_t Send(Command command, std::vector<LogLine> lines);

  bool running() const;  ///< In real time.
  bool looping() const;  ///< Through the history.
  /// The frame that is shown, or will be when what was sent is done.
  int frame() const;
  /// Whether all that was sent is done, and a frame has come of it.
  bool caughtUp() const { return idle() && snapshot_.report.frame != lastDoneFrame_; }

  void Run(bool running);
  void TogglePause() { Run(!running() && !looping()); }
  /// One frame. Does nothing, and returns false, while running.
  bool StepOneFrame();
  /// Many frames, in pieces that can be watched.
  void StepFrames(int frames);

  // The past. Each returns whether there was something to do.
  bool Seek(int frame);  ///< To a frame of the history, paused.
  bool StepBack();       ///< To the frame before, paused.
  bool StepForward();    ///< To the frame after, paused; after the last, one new frame.
  bool ToggleLoop();     ///< Shows the history again and again, or stops.

 private:
  bool idle() const { return lastDone_ == lastSent_; }

  SessionLog& log_;
  Simulation simulation_;
  Snapshot snapshot_;
  TimeMode wanted_ = TimeMode::Paused;
  std::uint64_t lastSent_ = 0, lastDone_ = 0;
  int lastDoneFrame_ = -1;    // That the last command left.
  std::uint64_t sought_ = 0;  // The last command to seek, and where to.
  int soughtFrame_ = 0;
};

}  // namespace percale::viewer
