#pragma once
/// \file
/// The states of past frames, within a budget of memory.

#include <cstddef>
#include <deque>
#include <memory>

#include "percale/world.h"

namespace percale::viewer {

/// What there is of it, for the window.
struct HistoryInfo {
  int firstFrame = 0, lastFrame = -1;  ///< Kept are all from the first to the last; none where last < first.
  std::size_t bytes = 0;               ///< Of memory in use.
  std::size_t budget = 0;              ///< 0: switched off.
  bool full = false;  ///< The budget has been reached since it was set, or the last Clear: old frames have gone.
};

class History {
 public:
  /// `budget` in bytes; 0 keeps nothing and costs nothing.
  explicit History(std::size_t budget) : budget_(budget) {}

  /// Keeps the state of the World as it is, as that of its frame. What was kept of this frame and of later
  /// ones goes: they belong to another future. Where the budget is reached, the oldest frames go; one
  /// always stays.
  void Record(const World& world);
  void Clear();
  /// Drops what does not fit any more. With 0 everything.
  void SetBudget(std::size_t bytes);

  /// The state of a frame, or null where it is not kept.
  const WorldState* Find(int frame) const;
  HistoryInfo info() const;

 private:
  void DropOldest();

  std::size_t budget_ = 0;
  std::size_t bytes_ = 0;
  bool full_ = false;
  int firstFrame_ = 0;
  std::deque<std::unique_ptr<WorldState>> states_;  // Of successive frames.
  std::unique_ptr<WorldState> spare_;               // Of a frame that has gone: its memory is used again.
};

}  // namespace percale::viewer
