#include "apps/viewer/simulation.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <utility>

namespace percale::viewer {
namespace {

/// A frame that comes late is made up for by at most so many in a row; time beyond that is lost, so
/// that a pause of the machine does not end in a rush.
constexpr int kCatchUpFrames = 4;
/// Over which the speed is measured [s].
constexpr double kRatePeriod = 0.5;

bool SameEdges(std::span<const Edge> a, std::span<const Edge> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Edge& p, const Edge& q) { return p.a == q.a && p.b == q.b; });
}
bool SameTriangles(std::span<const Triangle> a, std::span<const Triangle> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Triangle& p, const Triangle& q) { return p.a == q.a && p.b == q.b && p.c == q.c; });
}
template <class T>
std::vector<T> Copy(std::span<const T> span) {
  return {span.begin(), span.end()};
}

}  // namespace

Simulation::Simulation(Scene scene, SimulationOptions options)
    : options_(std::move(options)),
      timeline_(std::move(scene), {options_.threads, options_.hashes, options_.historyBudget,
                                   [this](const StepReport& report) { reports_.push_back(report); }}) {
  CopyTopologies();
  Publish();
  thread_ = std::thread([this] { Loop(); });
}

Simulation::~Simulation() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

std::uint64_t Simulation::Send(Command command) {
  using enum Command::Kind;
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    number = command.number = ++lastNumber_;
    const bool mayReplace =
        command.kind == Apply || command.kind == Handles || command.kind == Place || command.kind == Seek;
    const bool replaces = mayReplace && !command.undoable && !commands_.empty() &&
                          commands_.back().kind == command.kind && !commands_.back().undoable;
    if (replaces)
      commands_.back() = std::move(command);
    else
      commands_.push_back(std::move(command));
  }
  wake_.notify_one();
  return number;
}

void Simulation::WantContacts(bool wanted) {
  {
    const std::lock_guard lock(mutex_);
    if (wantsContacts_ == wanted) return;
    wantsContacts_ = wanted;
    contactsDue_ = wanted;
  }
  wake_.notify_one();
}

bool Simulation::TakeSnapshot(Snapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  if (!fresh_) return false;
  fresh_ = false;
  std::swap(snapshot, ready_);
  ready_.executed.clear();
  ready_.reports.clear();
  return true;
}

std::string Simulation::TakeFailure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, {});
}

void Simulation::Loop() {
  std::string failure;
  try {
    LoopOrThrow();
    return;
  } catch (const std::bad_alloc&) {
    failure = "the simulation ran out of memory";
  } catch (const std::exception& error) {
    failure = std::string("the simulation stopped: ") + error.what();
  }
  {
    const std::lock_guard lock(mutex_);
    failure_ = failure;
  }
  if (options_.onSnapshot) options_.onSnapshot();
}

void Simulation::LoopOrThrow() {
  for (;;) {
    Command command;
    bool hasCommand = false, contactsDue = false;
    {
      std::unique_lock lock(mutex_);
      const auto awake = [this] { return stop_ || !commands_.empty() || contactsDue_; };
      if (mode_ != TimeMode::Paused)
        wake_.wait_until(lock, nextFrame_, awake);
      else
        wake_.wait(lock, awake);
      if (stop_) return;
      contactsDue = std::exchange(contactsDue_, false);
      if (!commands_.empty()) {
        command = std::move(commands_.front());
        commands_.pop_front();
        hasCommand = true;
      }
    }
    if (hasCommand) {
      Execute(std::move(command));
      Publish();
      continue;
    }
    const Clock::time_point now = Clock::now();
    if (mode_ == TimeMode::Paused || now < nextFrame_) {
      if (contactsDue) Publish();
      continue;
    }
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / std::max(1, timeline_.world().scene().simulation.framesPerSecond)));
    nextFrame_ = std::max(nextFrame_ + period, now - kCatchUpFrames * period);
    ShowNextFrame();
    Publish();
  }
}

void Simulation::Execute(Command command) {
  using enum Command::Kind;
  const Command::Kind kind = command.kind;
  const bool changesFrame = kind == Reset || kind == Seek || kind == Restore || kind == Load;
  mode_ = ModeAfter(kind, mode_);
  if (timeline_.world().report().divergence && kind == Run) mode_ = TimeMode::Paused;
  if (kind == Run || kind == Loop || kind == Pause) {
    nextFrame_ = rateSince_ = Clock::now();
    framesSince_ = 0;
  }
  const int frames = command.frames;
  const auto begin = Clock::now();
  executed_.push_back(timeline_.Execute(std::move(command)));
  if (kind == Step) frameSeconds_ = std::chrono::duration<double>(Clock::now() - begin).count() / frames;
  if (changesFrame) frameSeconds_ = 0;
  if (mode_ == TimeMode::Paused) framesPerSecond_ = 0;
  CopyTopologies();
}

void Simulation::ShowNextFrame() {
  const Clock::time_point begin = Clock::now();
  const bool shown = mode_ == TimeMode::Looping ? timeline_.LoopFrame() : timeline_.StepFrame();
  if (mode_ == TimeMode::Running) frameSeconds_ = std::chrono::duration<double>(Clock::now() - begin).count();
  if (mode_ == TimeMode::Looping) CopyTopologies();
  if (!shown) mode_ = TimeMode::Paused;
  CountFrame();
}

void Simulation::CountFrame() {
  if (mode_ == TimeMode::Paused) return;
  const Clock::time_point now = Clock::now();
  ++framesSince_;
  const double period = std::chrono::duration<double>(now - rateSince_).count();
  if (period < kRatePeriod) return;
  framesPerSecond_ = framesSince_ / period;
  rateSince_ = now;
  framesSince_ = 0;
}

void Simulation::CopyTopologies() {
  const World& world = timeline_.world();
  if (world.sharedScene() == topologyScene_) return;
  topologyScene_ = world.sharedScene();
  topologies_.resize(static_cast<std::size_t>(world.ClothCount()));
  for (int c = 0; c < world.ClothCount(); ++c) {
    std::shared_ptr<const ClothTopology>& old = topologies_[static_cast<std::size_t>(c)];
    const ClothView cloth = world.Cloth(c);
    if (old && SameEdges(old->springs, cloth.springs()) && SameTriangles(old->triangles, cloth.triangles()) &&
        std::equal(old->uv.begin(), old->uv.end(), cloth.uv().begin(), cloth.uv().end()) &&
        std::equal(old->rest.begin(), old->rest.end(), cloth.rest().begin(), cloth.rest().end()) &&
        std::equal(old->restLengths.begin(), old->restLengths.end(), cloth.restLengths().begin(),
                   cloth.restLengths().end()) &&
        std::equal(old->pinned.begin(), old->pinned.end(), cloth.pinned().begin(), cloth.pinned().end())) {
      continue;
    }
    old = std::make_shared<const ClothTopology>(ClothTopology{Copy(cloth.uv()), Copy(cloth.triangles()),
                                                              Copy(cloth.springs()), Copy(cloth.rest()),
                                                              Copy(cloth.pinned()), Copy(cloth.restLengths())});
  }
}

/// Makes the state of the World the newest snapshot.
void Simulation::Publish() {
  const World& world = timeline_.world();
  bool wantsContacts = false;
  {
    const std::lock_guard lock(mutex_);
    wantsContacts = wantsContacts_;
  }
  back_.contacts.clear();
  if (wantsContacts && world.scene().simulation.engine == Engine::Fabric) {
    world.Save(touched_);
    back_.contacts = ReadContacts(touched_);
  }
  back_.scene = world.sharedScene();
  back_.cloths.resize(topologies_.size());
  for (std::size_t c = 0; c < topologies_.size(); ++c) {
    const ClothView cloth = world.Cloth(static_cast<int>(c));
    back_.cloths[c].positions.assign(cloth.positions().begin(), cloth.positions().end());
    back_.cloths[c].velocities.assign(cloth.velocities().begin(), cloth.velocities().end());
    back_.cloths[c].topology = topologies_[c];
  }
  back_.balls.assign(world.balls().begin(), world.balls().end());
  back_.report = world.report();
  back_.history = timeline_.history().info();
  back_.running = mode_ == TimeMode::Running;
  back_.looping = mode_ == TimeMode::Looping;
  back_.frameSeconds = frameSeconds_;
  back_.framesPerSecond = framesPerSecond_;
  back_.hash = timeline_.Hash();
  {
    const std::lock_guard lock(mutex_);
    // What was carried out before a snapshot that nobody took is told with this one.
    back_.executed = std::move(ready_.executed);
    back_.executed.insert(back_.executed.end(), executed_.begin(), executed_.end());
    back_.reports = std::move(ready_.reports);
    back_.reports.insert(back_.reports.end(), reports_.begin(), reports_.end());
    std::swap(back_, ready_);
    fresh_ = true;
  }
  executed_.clear();
  back_.executed.clear();
  reports_.clear();
  back_.reports.clear();
  if (options_.onSnapshot) options_.onSnapshot();
}

}  // namespace percale::viewer
