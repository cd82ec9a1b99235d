// What the window takes for granted before the simulation has done it.
#include "apps/viewer/playback.h"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

using namespace percale;
using namespace percale::viewer;

namespace {

Scene SmallScene() {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = cloth.numHeightPoints = 12;
  cloth.thickness = 0.01;
  cloth.pinned = {{0, 0}, {11, 0}};
  scene.cloths.push_back(cloth);
  return scene;
}

/// Waits until command `number` is carried out.
void WaitFor(Playback& playback, std::uint64_t number) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    if (playback.Update()) {
      for (const Executed& done : playback.snapshot().executed) {
        if (done.command == number) return;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  FAIL("the command was not carried out");
}

}  // namespace

TEST_CASE("what was sent counts as done, and is what comes of it") {
  SessionLog log;
  Playback playback(SmallScene(), {.threads = 1, .historyBudget = std::size_t{8} << 20}, log);
  CHECK_FALSE(playback.running());
  playback.TogglePause();
  CHECK(playback.running());
  CHECK_FALSE(playback.StepOneFrame());
  playback.TogglePause();
  CHECK_FALSE(playback.running());

  playback.StepFrames(12);
  WaitFor(playback, playback.Send({.kind = Command::Kind::Pause}));
  const int last = playback.frame();
  CHECK(last >= 12);
  CHECK_FALSE(playback.Seek(last + 1));
  REQUIRE(playback.StepBack());
  REQUIRE(playback.StepBack());
  CHECK(playback.frame() == last - 2);
  REQUIRE(playback.StepForward());
  CHECK(playback.frame() == last - 1);
  REQUIRE(playback.ToggleLoop());
  CHECK(playback.looping());
  CHECK_FALSE(playback.running());
  REQUIRE(playback.Seek(3));
  CHECK_FALSE(playback.looping());
  WaitFor(playback, playback.Send({.kind = Command::Kind::Pause}));
  CHECK(playback.frame() == 3);
  CHECK(playback.snapshot().report.frame == 3);
}

TEST_CASE("a command is caught up with when a frame has come of it") {
  SessionLog log;
  Playback playback(SmallScene(), {.threads = 1}, log);
  const std::uint64_t command = playback.Send({.kind = Command::Kind::Handles});
  CHECK_FALSE(playback.caughtUp());
  WaitFor(playback, command);
  CHECK_FALSE(playback.caughtUp());
  playback.Run(true);
  CHECK_FALSE(playback.caughtUp());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!playback.caughtUp() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    playback.Update();
  }
  CHECK(playback.caughtUp());
  CHECK(playback.snapshot().report.frame > 0);
  playback.Run(false);
  CHECK_FALSE(playback.caughtUp());
}

TEST_CASE("without a history there is nothing to go back to") {
  SessionLog log;
  Playback playback(SmallScene(), {.threads = 1}, log);
  REQUIRE(playback.StepForward());  // A new frame.
  WaitFor(playback, playback.Send({.kind = Command::Kind::Pause}));
  CHECK(playback.frame() == 1);
  CHECK_FALSE(playback.StepBack());
  CHECK_FALSE(playback.ToggleLoop());
}
