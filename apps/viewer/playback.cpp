#include "apps/viewer/playback.h"

#include <algorithm>
#include <utility>

namespace percale::viewer {
namespace {

/// Many frames are sent in pieces of so many.
constexpr int kFramesAtOnce = 5;

}  // namespace

Playback::Playback(Scene scene, SimulationOptions options, SessionLog& log)
    : log_(log), simulation_(std::move(scene), std::move(options)) {
  simulation_.TakeSnapshot(snapshot_);
}

bool Playback::Update() {
  if (!simulation_.TakeSnapshot(snapshot_)) return false;
  for (const Executed& done : snapshot_.executed) {
    lastDone_ = std::max(lastDone_, done.command);
    lastDoneFrame_ = done.frame;
    log_.Write(LogLine("done")
                   .Number("command", static_cast<double>(done.command))
                   .Number("at", done.at)
                   .Number("frame", done.frame)
                   .Hash("hash", done.hash)
                   .Flag("kept", done.stateKept));
  }
  return true;
}

std::uint64_t Playback::Send(Command command) {
  LogLine line = DescribeCommand(command);
  return Send(std::move(command), {std::move(line)});
}

std::uint64_t Playback::Send(Command command, std::vector<LogLine> lines) {
  wanted_ = ModeAfter(command.kind, wanted_);
  lastSent_ = simulation_.Send(std::move(command));
  for (LogLine& line : lines) log_.Write(line.Number("command", static_cast<double>(lastSent_)));
  return lastSent_;
}

bool Playback::running() const {
  return idle() ? snapshot_.running : wanted_ == TimeMode::Running;
}

bool Playback::looping() const {
  return idle() ? snapshot_.looping : wanted_ == TimeMode::Looping;
}

int Playback::frame() const {
  return sought_ > lastDone_ && sought_ == lastSent_ ? soughtFrame_ : snapshot_.report.frame;
}

void Playback::Run(bool running) {
  Send({.kind = running ? Command::Kind::Run : Command::Kind::Pause});
}

bool Playback::StepOneFrame() {
  if (running() || looping()) return false;
  Send({.kind = Command::Kind::Step, .frames = 1});
  return true;
}

void Playback::StepFrames(int frames) {
  for (; frames > 0; frames -= kFramesAtOnce)
    Send({.kind = Command::Kind::Step, .frames = std::min(frames, kFramesAtOnce)});
}

bool Playback::Seek(int frame) {
  const HistoryInfo& history = snapshot_.history;
  if (frame < history.firstFrame || frame > history.lastFrame) return false;
  soughtFrame_ = frame;
  sought_ = Send({.kind = Command::Kind::Seek, .frame = frame});
  return true;
}

bool Playback::StepBack() {
  return Seek(frame() - 1);
}

bool Playback::StepForward() {
  return Seek(frame() + 1) || StepOneFrame();
}

bool Playback::ToggleLoop() {
  if (looping()) {
    Run(false);
    return true;
  }
  if (snapshot_.history.budget == 0) return false;
  Send({.kind = Command::Kind::Loop});
  return true;
}

}  // namespace percale::viewer
