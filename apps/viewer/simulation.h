#pragma once
/// \file
/// A timeline on a thread of its own. The window sends commands and takes copies of the newest state;
/// neither waits for the other, so a cloth of any size leaves the window answering.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/viewer/timeline.h"
#include "percale/contacts.h"
#include "percale/world.h"

namespace percale::viewer {

/// What of a cloth stays the same from frame to frame. Never changed once made.
struct ClothTopology {
  std::vector<Vec2> uv;
  std::vector<Triangle> triangles;
  std::vector<Edge> springs;  ///< Of the enabled kinds.
  std::vector<Vec3> rest;     ///< Where it started [m].
  std::vector<std::int32_t> pinned;
  std::vector<double> restLengths;  ///< Of the springs [m].
};

struct ClothCopy {
  std::vector<Vec3> positions;   ///< [m]
  std::vector<Vec3> velocities;  ///< [m/s]
  std::shared_ptr<const ClothTopology> topology;
};

/// A copy of everything that the window shows of a World, of one moment.
struct Snapshot {
  std::shared_ptr<const Scene> scene;
  std::vector<ClothCopy> cloths;  ///< In the scene's order.
  std::vector<Ball> balls;
  std::vector<ContactForce> contacts;  ///< Where they are wanted.
  StepReport report;
  HistoryInfo history;
  bool running = false;             ///< In real time.
  bool looping = false;             ///< Through the history.
  double frameSeconds = 0;          ///< Wall-clock time of the last frame [s]; 0 before the first.
  double framesPerSecond = 0;       ///< Simulated in the last half second of running; 0 while paused.
  std::uint64_t hash = 0;           ///< World::StateHash; 0 unless hashes were asked for.
  std::vector<Executed> executed;   ///< Since the last snapshot that was taken, in order.
  std::vector<StepReport> reports;  ///< Of the frames simulated since then, in order.
};

struct SimulationOptions {
  int threads = 0;                ///< Of the World; 0: as many as the machine has cores.
  bool hashes = false;            ///< Fingerprint every state, for a log.
  std::size_t historyBudget = 0;  ///< Memory for past frames [bytes]; 0: none are kept.
  /// Called on the simulation's thread when there is a new snapshot. It must not call back.
  std::function<void()> onSnapshot = {};
};

class Simulation {
 public:
  /// Builds the World of `scene`, which must pass CheckScene, and starts paused.
  Simulation(Scene scene, SimulationOptions options);
  /// Waits for the frame under way, then ends the thread.
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Appends a command to those that wait; they are carried out in order, between two frames. Returns
  /// its number, from 1 on. Of several Apply, Handles or Seek in a row that wait, the newest alone is carried
  /// out, unless it is to be undoable.
  std::uint64_t Send(Command command);

  /// Whether snapshots are to tell the forces of contact; if so, there is a new one soon.
  void WantContacts(bool wanted);
  /// Puts the newest state into `snapshot`, whose memory is used again. Returns false, and leaves it
  /// alone, when there is none since the last call.
  bool TakeSnapshot(Snapshot& snapshot);
  /// Why the simulation ended by itself ("the simulation ran out of memory"), told once; else empty.
  std::string TakeFailure();

 private:
  using Clock = std::chrono::steady_clock;
  void Loop();
  void LoopOrThrow();
  void Execute(Command command);
  void ShowNextFrame();
  void CountFrame();
  void Publish();
  void CopyTopologies();

  // The simulation's thread only, once it runs.
  SimulationOptions options_;
  Timeline timeline_;
  std::vector<std::shared_ptr<const ClothTopology>> topologies_;
  std::shared_ptr<const Scene> topologyScene_;  // They are those of its cloths.
  Snapshot back_;
  WorldState touched_;  // To read contacts from.
  TimeMode mode_ = TimeMode::Paused;
  double frameSeconds_ = 0;
  double framesPerSecond_ = 0;
  std::vector<Executed> executed_;
  std::vector<StepReport> reports_;
  Clock::time_point nextFrame_, rateSince_;
  int framesSince_ = 0;

  // Shared.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Command> commands_;
  std::uint64_t lastNumber_ = 0;
  bool stop_ = false;
  bool wantsContacts_ = false, contactsDue_ = false;
  Snapshot ready_;
  bool fresh_ = false;
  std::string failure_;

  std::thread thread_;
};

}  // namespace percale::viewer
