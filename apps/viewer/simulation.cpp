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
    : options_(std::move(options)), world_(std::move(scene), WorldOptions{.threads = options_.threads}) {
  scene_ = std::make_shared<const Scene>(world_.scene());
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

std::uint64_t Simulation::SetRunning(bool running) {
  Command command;
  command.kind = running ? Command::Kind::Run : Command::Kind::Pause;
  return Send(std::move(command));
}

std::uint64_t Simulation::StepFrames(int frames) {
  Command command;
  command.kind = Command::Kind::Step;
  command.frames = frames;
  return Send(std::move(command));
}

std::uint64_t Simulation::Reset() {
  Command command;
  command.kind = Command::Kind::Reset;
  return Send(std::move(command));
}

std::uint64_t Simulation::Apply(Scene scene) {
  Command command;
  command.kind = Command::Kind::Apply;
  command.scene = std::make_unique<Scene>(std::move(scene));
  return Send(std::move(command));
}

std::uint64_t Simulation::Send(Command command) {
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    number = command.number = ++lastNumber_;
    const bool replaces =
        command.kind == Command::Kind::Apply && !commands_.empty() && commands_.back().kind == Command::Kind::Apply;
    if (replaces)
      commands_.back() = std::move(command);
    else
      commands_.push_back(std::move(command));
  }
  wake_.notify_one();
  return number;
}

bool Simulation::TakeSnapshot(Snapshot& snapshot) {
  const std::lock_guard lock(mutex_);
  if (!fresh_) return false;
  fresh_ = false;
  std::swap(snapshot, ready_);
  ready_.executed.clear();
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
    bool hasCommand = false;
    {
      std::unique_lock lock(mutex_);
      const auto awake = [this] { return stop_ || !commands_.empty(); };
      if (running_)
        wake_.wait_until(lock, nextFrame_, awake);
      else
        wake_.wait(lock, awake);
      if (stop_) return;
      if (!commands_.empty()) {
        command = std::move(commands_.front());
        commands_.pop_front();
        hasCommand = true;
      }
    }
    if (hasCommand) {
      Execute(command);
      Publish();
      continue;
    }
    const Clock::time_point now = Clock::now();
    if (!running_ || now < nextFrame_) continue;
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / std::max(1, scene_->simulation.framesPerSecond)));
    nextFrame_ = std::max(nextFrame_ + period, now - kCatchUpFrames * period);
    StepOneFrame();
    Publish();
  }
}

void Simulation::Execute(Command& command) {
  Executed done{.command = command.number};
  switch (command.kind) {
    case Command::Kind::Run:
      running_ = !world_.report().divergence;
      nextFrame_ = rateSince_ = Clock::now();
      framesSince_ = 0;
      break;
    case Command::Kind::Pause:
      running_ = false;
      framesPerSecond_ = 0;
      break;
    case Command::Kind::Step:
      for (int frame = 0; frame < command.frames; ++frame) StepOneFrame();
      break;
    case Command::Kind::Reset:
      world_.Reset();
      frameSeconds_ = 0;
      done.stateKept = false;
      break;
    case Command::Kind::Apply:
      done.stateKept = world_.Apply(std::move(*command.scene));
      scene_ = std::make_shared<const Scene>(world_.scene());
      CopyTopologies();
      break;
  }
  done.frame = world_.report().frame;
  done.hash = options_.hashes ? world_.StateHash() : 0;
  executed_.push_back(done);
}

void Simulation::StepOneFrame() {
  const Clock::time_point begin = Clock::now();
  world_.Step();
  const Clock::time_point end = Clock::now();
  frameSeconds_ = std::chrono::duration<double>(end - begin).count();
  if (world_.report().divergence) running_ = false;
  if (!running_) return;
  ++framesSince_;
  const double period = std::chrono::duration<double>(end - rateSince_).count();
  if (period < kRatePeriod) return;
  framesPerSecond_ = framesSince_ / period;
  rateSince_ = end;
  framesSince_ = 0;
}

void Simulation::CopyTopologies() {
  topologies_.resize(static_cast<std::size_t>(world_.ClothCount()));
  for (int c = 0; c < world_.ClothCount(); ++c) {
    std::shared_ptr<const ClothTopology>& old = topologies_[static_cast<std::size_t>(c)];
    const ClothView cloth = world_.Cloth(c);
    if (old && SameEdges(old->springs, cloth.springs()) && SameTriangles(old->triangles, cloth.triangles()) &&
        std::equal(old->uv.begin(), old->uv.end(), cloth.uv().begin(), cloth.uv().end())) {
      continue;
    }
    old = std::make_shared<const ClothTopology>(
        ClothTopology{Copy(cloth.uv()), Copy(cloth.triangles()), Copy(cloth.springs())});
  }
}

/// Makes the state of the World the newest snapshot.
void Simulation::Publish() {
  back_.scene = scene_;
  back_.cloths.resize(topologies_.size());
  for (std::size_t c = 0; c < topologies_.size(); ++c) {
    const std::span<const Vec3> positions = world_.Cloth(static_cast<int>(c)).positions();
    back_.cloths[c].positions.assign(positions.begin(), positions.end());
    back_.cloths[c].topology = topologies_[c];
  }
  back_.report = world_.report();
  back_.running = running_;
  back_.frameSeconds = frameSeconds_;
  back_.framesPerSecond = framesPerSecond_;
  back_.hash = options_.hashes ? world_.StateHash() : 0;
  {
    const std::lock_guard lock(mutex_);
    // What was carried out before a snapshot that nobody took is told with this one.
    back_.executed = std::move(ready_.executed);
    back_.executed.insert(back_.executed.end(), executed_.begin(), executed_.end());
    std::swap(back_, ready_);
    fresh_ = true;
  }
  executed_.clear();
  back_.executed.clear();
  if (options_.onSnapshot) options_.onSnapshot();
}

}  // namespace percale::viewer
