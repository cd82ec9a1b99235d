#include "apps/viewer/undo.h"

#include <algorithm>
#include <utility>

#include "percale/parameters.h"

namespace percale::viewer {

Scene WithChange(const Scene& scene, const Scene& from, const Scene& to) {
  Scene changed = scene;
  for (const auto& [parameter, index] : Differences(from, to)) {
    const ParameterGroup& group = *FindGroup(parameter->group);
    if (index >= std::min(group.count(to), group.count(changed))) return to;
    parameter->set(changed, index, parameter->get(to, index));
  }
  return HasErrors(CheckScene(changed)) ? to : changed;
}

void UndoStack::Hold(bool held) {
  if (!held) begun_ = false;
  held_ = held;
}

bool UndoStack::Merges(const std::string& path) const {
  return begun_ && !done_.empty() && done_.back().path == path;
}

void UndoStack::Push(Change change) {
  undone_.clear();
  begun_ = held_ && !change.path.empty();
  done_.push_back(std::move(change));
  if (done_.size() > kMost) done_.erase(done_.begin());
}

void UndoStack::Extend(const Scene& after) {
  done_.back().after = after;
}

void UndoStack::Extend(const ShaderValues& after) {
  done_.back().valuesAfter = after;
}

void UndoStack::Undone(std::uint64_t command) {
  undone_.push_back(std::move(done_.back()));
  done_.pop_back();
  undone_.back().command = command;
  begun_ = false;
}

void UndoStack::Redone(std::uint64_t command) {
  done_.push_back(std::move(undone_.back()));
  undone_.pop_back();
  done_.back().command = command;
  begun_ = false;
}

void UndoStack::Clear() {
  done_.clear();
  undone_.clear();
  begun_ = false;
}

}  // namespace percale::viewer
