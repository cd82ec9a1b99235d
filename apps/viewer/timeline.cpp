#include "apps/viewer/timeline.h"

#include <algorithm>

namespace percale::viewer {

Timeline::Timeline(Scene scene, const Options& options)
    : options_(options),
      world_(std::move(scene), WorldOptions{.threads = options.threads}),
      history_(options.historyBudget) {
  history_.Record(world_);
}

Executed Timeline::Execute(Command command) {
  using enum Command::Kind;
  Executed done{.command = command.number, .at = world_.report().frame};
  if (command.undoable) KeepStateBefore(command.number);
  // A hand may still hold on to a cloth that has been replaced.
  std::erase_if(command.handles, [this](const Handle& handle) { return !Exists(handle); });
  switch (command.kind) {
    case Run:
    case Loop:
    case Pause:
      done.scene = world_.sharedScene();  // A loop stops at any frame of the history.
      break;
    case Step:
      for (int frame = 0; frame < command.frames && StepFrame(); ++frame) {
      }
      break;
    case Reset:
      world_.Reset();
      history_.Record(world_);
      done.stateKept = false;
      break;
    case Apply:
      done.stateKept = world_.Apply(std::move(*command.scene));
      history_.Record(world_);
      break;
    case Handles:
      world_.SetHandles(std::move(command.handles));
      history_.Record(world_);
      break;
    case Place:
      for (const Handle& handle : command.handles) world_.Place(handle);
      history_.Record(world_);
      break;
    case Ball:
      world_.AddBall(command.ball);
      history_.Record(world_);
      break;
    case Gust:
      command.gust.start += world_.report().time;
      world_.AddGust(command.gust);
      history_.Record(world_);
      break;
    case Seek:
      done.stateKept = command.frame == done.at;
      if (this->Seek(command.frame))
        done.scene = world_.sharedScene();
      else
        done.failure = "frame " + std::to_string(command.frame) + " is not in the history";
      break;
    case Restore: {
      const auto found = std::find_if(undoStates_.begin(), undoStates_.end(),
                                      [&](const auto& entry) { return entry.first == command.before; });
      if (found == undoStates_.end()) {
        done.failure = "the state before it is not kept any more";
        break;
      }
      world_.Restore(*found->second);
      history_.Record(world_);
      done.scene = world_.sharedScene();
      done.stateKept = false;
      break;
    }
    case Load:
      world_.Restore(*command.state);
      history_.Clear();
      history_.Record(world_);
      done.scene = world_.sharedScene();
      done.stateKept = false;
      break;
    case Save: {
      auto state = std::make_shared<WorldState>();
      world_.Save(*state);
      done.state = std::move(state);
      break;
    }
    case Budget:
      history_.SetBudget(command.budget);
      history_.Record(world_);
      break;
  }
  done.frame = world_.report().frame;
  done.hash = Hash();
  return done;
}

bool Timeline::StepFrame() {
  if (world_.report().divergence) return false;
  world_.Step();
  if (world_.report().divergence) return false;
  history_.Record(world_);
  if (options_.onFrame) options_.onFrame(world_.report());
  return true;
}

bool Timeline::LoopFrame() {
  const HistoryInfo info = history_.info();
  const int next = world_.report().frame + 1;
  return Seek(next <= info.lastFrame ? next : info.firstFrame);
}

bool Timeline::Seek(int frame) {
  const WorldState* state = history_.Find(frame);
  if (!state) return false;
  world_.Restore(*state);
  return true;
}

bool Timeline::Exists(const Handle& handle) const {
  if (handle.cloth < 0 || handle.cloth >= world_.ClothCount() || handle.vertex < 0) return false;
  return static_cast<std::size_t>(handle.vertex) < world_.Cloth(handle.cloth).positions().size();
}

void Timeline::KeepStateBefore(std::uint64_t command) {
  auto state = std::make_shared<WorldState>();
  world_.Save(*state);
  undoBytes_ += state->Bytes();
  undoStates_.emplace_back(command, std::move(state));
  while (undoBytes_ > kUndoBudget && undoStates_.size() > 1) {
    undoBytes_ -= undoStates_.front().second->Bytes();
    undoStates_.pop_front();
  }
}

}  // namespace percale::viewer
