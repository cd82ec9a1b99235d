#pragma once
/// \file
/// A World with its past, and the commands that change it. The viewer runs one on a thread of its own
/// (simulation.h), `percale replay` another one from a log: the same commands after the same frames give
/// the same bits.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/viewer/history.h"
#include "percale/world.h"

namespace percale::viewer {

/// Memory that the states before commands may take, so that they can be undone [bytes].
inline constexpr std::size_t kUndoBudget = std::size_t{64} << 20;

struct Command {
  enum class Kind {
    Run,      ///< From here on in real time...
    Loop,     ///< ...or through the history, again and again...
    Pause,    ///< ...or not at all.
    Step,     ///< `frames` frames.
    Reset,    ///< To the start.
    Apply,    ///< Settings `scene`.
    Handles,  ///< Grips `handles` in place of those there were.
    Place,    ///< Puts the cloth of `handles` where they want it: for a hand while time stands.
    Ball,     ///< One more `ball`.
    Gust,     ///< A `gust` from now on: its start counts from now.
    Seek,     ///< To a frame of the history: `frame`.
    Restore,  ///< To the state before the command of number `before`, which was undoable.
    Load,     ///< To `state`.
    Save,     ///< Hands out the state.
    Budget,   ///< `budget` bytes of history from now on.
  } kind = Kind::Pause;
  std::uint64_t number = 0;
  bool undoable = false;  ///< Keep the state before it.
  int frames = 1;
  int frame = 0;
  std::uint64_t before = 0;  ///< For Restore: the number of the command whose state before it is meant.
  std::size_t budget = 0;
  std::unique_ptr<Scene> scene = nullptr;
  std::vector<Handle> handles = {};
  Ball ball = {};
  Gust gust = {};
  std::shared_ptr<const WorldState> state = nullptr;
};

/// How time goes on by itself: not at all, in real time, or through the history.
enum class TimeMode { Paused, Running, Looping };

/// After a command of that kind.
inline TimeMode ModeAfter(Command::Kind kind, TimeMode before) {
  using enum Command::Kind;
  if (kind == Run) return TimeMode::Running;
  if (kind == Loop) return TimeMode::Looping;
  const bool ends = kind == Pause || kind == Seek || kind == Restore || kind == Load;
  return ends ? TimeMode::Paused : before;
}

/// A command that has been carried out.
struct Executed {
  std::uint64_t command = 0;                     ///< Its number.
  int at = 0;                                    ///< The frame that it found.
  int frame = 0;                                 ///< The frame that it left.
  std::uint64_t hash = 0;                        ///< World::StateHash afterwards; 0 unless hashes were asked for.
  bool stateKept = true;                         ///< Whether the cloths are where they were.
  std::string failure = {};                      ///< Why it did nothing; else empty.
  std::shared_ptr<const Scene> scene = {};       ///< The settings, where others may have come with a frame.
  std::shared_ptr<const WorldState> state = {};  ///< For Save.
};

class Timeline {
 public:
  struct Options {
    int threads = 0;                                      ///< Of the World; 0: as many as the machine has cores.
    bool hashes = false;                                  ///< Fingerprint every state.
    std::size_t historyBudget = 0;                        ///< [bytes]; 0: no history.
    std::function<void(const StepReport&)> onFrame = {};  ///< Called with each new frame.
  };

  /// The World of `scene`, which must pass CheckScene, at its start.
  Timeline(Scene scene, const Options& options);

  /// Run, Loop and Pause do nothing here: whose thread it is keeps the time.
  Executed Execute(Command command);
  /// One frame on. Returns false when the simulation has diverged: nothing happened.
  bool StepFrame();
  /// Shows the next frame of the history, after its last the first. Returns false without history.
  bool LoopFrame();
  /// Back, or forth, to a frame of the history.
  bool Seek(int frame);

  const World& world() const { return world_; }
  const History& history() const { return history_; }
  std::uint64_t Hash() const { return options_.hashes ? world_.StateHash() : 0; }

 private:
  bool Exists(const Handle& handle) const;
  void KeepStateBefore(std::uint64_t command);

  Options options_;
  World world_;
  History history_;
  std::deque<std::pair<std::uint64_t, std::shared_ptr<const WorldState>>> undoStates_;  // By command, ascending.
  std::size_t undoBytes_ = 0;
};

}  // namespace percale::viewer
