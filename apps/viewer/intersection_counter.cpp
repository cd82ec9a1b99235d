#include "apps/viewer/intersection_counter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace percale::viewer {
namespace {

/// It rests so many times as long as it has counted: a quarter of one core at most.
constexpr double kRest = 3;
/// Coordinates that the judge takes [m].
constexpr double kFarthest = 1e90;

bool WithinReach(const Vec3& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

}  // namespace

IntersectionCounter::IntersectionCounter(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this] { Loop(); }) {}

IntersectionCounter::~IntersectionCounter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void IntersectionCounter::Offer(const Snapshot& snapshot) {
  for (const ClothCopy& cloth : snapshot.cloths) {
    if (!std::all_of(cloth.positions.begin(), cloth.positions.end(), WithinReach)) return;
  }
  {
    const std::lock_guard lock(mutex_);
    Topologies topologies;
    for (const ClothCopy& cloth : snapshot.cloths) topologies.push_back(cloth.topology);
    if (topologies != offered_.topologies) result_.reset();
    offered_.topologies = std::move(topologies);
    offered_.frame = snapshot.report.frame;
    offered_.positions.clear();
    for (const ClothCopy& cloth : snapshot.cloths)
      offered_.positions.insert(offered_.positions.end(), cloth.positions.begin(), cloth.positions.end());
    waiting_ = true;
  }
  changed_.notify_one();
}

std::optional<IntersectionCounter::Result> IntersectionCounter::result() const {
  const std::lock_guard lock(mutex_);
  return result_;
}

bool IntersectionCounter::TakeNews() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, false);
}

void IntersectionCounter::Loop() {
  State state;
  Clock::time_point ready = Clock::now();
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || waiting_; });
      if (changed_.wait_until(lock, ready, [this] { return stop_; }) || stop_) return;
      std::swap(state, offered_);
      offered_.topologies = state.topologies;
      waiting_ = false;
    }
    const Clock::time_point begin = Clock::now();
    const std::int64_t count = Count(state);
    const Clock::duration time = Clock::now() - begin;
    ready = Clock::now() + std::chrono::duration_cast<Clock::duration>(kRest * time);
    {
      const std::lock_guard lock(mutex_);
      // Other cloths may have taken the place of these.
      if (offered_.topologies != state.topologies) continue;
      result_ = Result{state.frame, count, std::chrono::duration<double>(time).count()};
      news_ = true;
    }
    if (wake_) wake_();
  }
}

std::int64_t IntersectionCounter::Count(const State& state) {
  if (!judge_ || judged_ != state.topologies) {
    std::vector<percale::ClothTopology> cloths;
    for (const auto& topology : state.topologies)
      cloths.push_back({static_cast<int>(topology->rest.size()), topology->triangles});
    judge_.emplace(cloths, 1);
    judged_ = state.topologies;
  }
  return judge_->Count(state.positions, 0).count;
}

}  // namespace percale::viewer
