#pragma once
/// \file
/// How often cloth passes through cloth, counted exactly (percale/intersections.h) on a thread of its own. Neither the
/// window nor the simulation waits for it: of the states that it is offered it takes the newest, whenever it is ready.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "apps/viewer/simulation.h"
#include "percale/intersections.h"

namespace percale::viewer {

class IntersectionCounter {
 public:
  struct Result {
    int frame = 0;           ///< In which it was counted.
    std::int64_t count = 0;  ///< Pairs of an edge and a triangle.
    double seconds = 0;      ///< That it took, on one thread [s].
  };

  /// `wake` is called on the thread when there is another result.
  explicit IntersectionCounter(std::function<void()> wake);
  ~IntersectionCounter();  ///< Waits for the count under way.
  IntersectionCounter(const IntersectionCounter&) = delete;
  IntersectionCounter& operator=(const IntersectionCounter&) = delete;

  /// Copies the positions of the cloths, in place of those that were offered before and are not begun.
  void Offer(const Snapshot& snapshot);
  /// The newest, of the cloths that were offered last; nothing before there is one.
  std::optional<Result> result() const;
  /// Whether there is another result than at the last call.
  bool TakeNews();

 private:
  using Clock = std::chrono::steady_clock;
  using Topologies = std::vector<std::shared_ptr<const ClothTopology>>;
  struct State {
    int frame = 0;
    Topologies topologies;
    std::vector<Vec3> positions;  // of all cloths
  };
  void Loop();
  std::int64_t Count(const State& state);

  std::function<void()> wake_;
  // The thread's only.
  std::optional<ClothJudge> judge_;
  Topologies judged_;  // Of whose cloths it is.
  // Shared.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State offered_;
  std::optional<Result> result_;
  bool waiting_ = false;  // What is offered is not begun.
  bool news_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace percale::viewer
