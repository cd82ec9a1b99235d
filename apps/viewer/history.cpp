#include "apps/viewer/history.h"

#include <utility>

namespace percale::viewer {

void History::Record(const World& world) {
  if (budget_ == 0) return;
  const int frame = world.report().frame;
  if (states_.empty() || frame < firstFrame_ || frame > info().lastFrame + 1) Clear();
  if (states_.empty()) firstFrame_ = frame;
  while (!states_.empty() && info().lastFrame >= frame) {
    bytes_ -= states_.back()->Bytes();
    spare_ = std::move(states_.back());
    states_.pop_back();
  }
  std::unique_ptr<WorldState> state = spare_ ? std::move(spare_) : std::make_unique<WorldState>();
  world.Save(*state);
  bytes_ += state->Bytes();
  states_.push_back(std::move(state));
  while (bytes_ > budget_ && states_.size() > 1) DropOldest();
}

void History::DropOldest() {
  full_ = true;
  bytes_ -= states_.front()->Bytes();
  spare_ = std::move(states_.front());
  states_.pop_front();
  ++firstFrame_;
}

void History::Clear() {
  states_.clear();
  spare_.reset();
  bytes_ = 0;
  firstFrame_ = 0;
  full_ = false;
}

void History::SetBudget(std::size_t bytes) {
  budget_ = bytes;
  full_ = false;
  if (budget_ == 0) Clear();
  while (bytes_ > budget_ && states_.size() > 1) DropOldest();
}

const WorldState* History::Find(int frame) const {
  if (frame < firstFrame_ || frame > info().lastFrame) return nullptr;
  return states_[static_cast<std::size_t>(frame - firstFrame_)].get();
}

HistoryInfo History::info() const {
  return {firstFrame_, firstFrame_ + static_cast<int>(states_.size()) - 1, bytes_, budget_, full_};
}

}  // namespace percale::viewer
