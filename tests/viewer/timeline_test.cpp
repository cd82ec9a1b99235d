// A World with its past, without a thread; and the replay of a log of it.
#include "apps/viewer/timeline.h"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "percale/parameters.h"

using namespace percale;
using namespace percale::viewer;

namespace {

constexpr std::size_t kPlenty = std::size_t{1} << 26;

Scene SmallScene() {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = cloth.numHeightPoints = 12;
  cloth.thickness = 0.01;
  cloth.pinned = {{0, 0}, {11, 0}};
  scene.cloths.push_back(cloth);
  return scene;
}

Timeline Make(std::size_t budget = kPlenty) {
  return Timeline(SmallScene(), {.threads = 1, .hashes = true, .historyBudget = budget});
}

Command Of(Command::Kind kind, std::uint64_t number = 1) {
  return {.kind = kind, .number = number};
}

Executed Steps(Timeline& timeline, int frames) {
  return timeline.Execute({.kind = Command::Kind::Step, .frames = frames});
}

Executed SetKs(Timeline& timeline, double ks) {
  auto scene = std::make_unique<Scene>(timeline.world().scene());
  scene->cloths[0].ks = ks;
  return timeline.Execute({.kind = Command::Kind::Apply, .scene = std::move(scene)});
}

}  // namespace

TEST_CASE("each frame of the history is the state that was simulated") {
  Timeline timeline = Make();
  std::vector<std::uint64_t> hashes = {timeline.Hash()};
  for (int frame = 1; frame <= 30; ++frame) hashes.push_back(Steps(timeline, 1).hash);
  CHECK(timeline.history().info().firstFrame == 0);
  CHECK(timeline.history().info().lastFrame == 30);
  for (const int frame : {12, 29, 0, 30, 17}) {
    const Executed done = timeline.Execute({.kind = Command::Kind::Seek, .frame = frame});
    CHECK(done.failure.empty());
    CHECK(done.frame == frame);
    CHECK(done.hash == hashes[static_cast<std::size_t>(frame)]);
  }
  CHECK_FALSE(timeline.Execute({.kind = Command::Kind::Seek, .frame = 31}).failure.empty());
  CHECK(timeline.world().report().frame == 17);
  // Going on without a change gives the same future.
  CHECK(Steps(timeline, 13).hash == hashes[30]);
}

TEST_CASE("a change in the past is another branch, and what belonged to the old one goes") {
  Timeline timeline = Make();
  Steps(timeline, 30);
  timeline.Seek(10);
  SetKs(timeline, 300);
  CHECK(timeline.history().info().lastFrame == 10);
  const std::uint64_t branch = Steps(timeline, 20).hash;

  Timeline other = Make();
  Steps(other, 10);
  SetKs(other, 300);
  CHECK(Steps(other, 20).hash == branch);
  // The frame at which it branched holds the new settings, the one before the old ones.
  timeline.Seek(10);
  CHECK(timeline.world().scene().cloths[0].ks == 300);
  timeline.Seek(9);
  CHECK(timeline.world().scene().cloths[0].ks == 5000);
}

TEST_CASE("the budget holds, the oldest frames go, and none is kept without one") {
  Timeline timeline = Make();
  Steps(timeline, 40);
  const std::size_t all = timeline.history().info().bytes;
  CHECK_FALSE(timeline.history().info().full);
  timeline.Execute({.kind = Command::Kind::Budget, .budget = all / 2});
  HistoryInfo info = timeline.history().info();
  CHECK(info.full);
  CHECK(info.bytes <= all / 2);
  CHECK(info.lastFrame == 40);
  CHECK(info.firstFrame >= 19);
  Steps(timeline, 40);
  info = timeline.history().info();
  CHECK(info.bytes <= all / 2);
  CHECK(info.lastFrame == 80);
  CHECK(timeline.Seek(info.firstFrame));
  CHECK_FALSE(timeline.Seek(info.firstFrame - 1));

  Timeline none = Make(0);
  Steps(none, 5);
  CHECK(none.history().info().lastFrame < none.history().info().firstFrame);
  CHECK(none.history().info().bytes == 0);
  CHECK_FALSE(none.Seek(5));
  CHECK_FALSE(none.LoopFrame());
}

TEST_CASE("it loops") {
  Timeline timeline = Make();
  Steps(timeline, 3);
  std::vector<int> frames;
  for (int i = 0; i < 6; ++i) {
    CHECK(timeline.LoopFrame());
    frames.push_back(timeline.world().report().frame);
  }
  CHECK(frames == std::vector<int>{0, 1, 2, 3, 0, 1});
}

TEST_CASE("where a loop stops, the settings are those of the frame") {
  Timeline timeline = Make();
  const double ks = timeline.world().scene().cloths[0].ks;
  Steps(timeline, 3);
  SetKs(timeline, 2 * ks);
  Steps(timeline, 3);
  timeline.Execute(Of(Command::Kind::Loop));
  CHECK(timeline.LoopFrame());  // The first again.
  const Executed done = timeline.Execute(Of(Command::Kind::Pause));
  REQUIRE(done.scene);
  CHECK(done.scene->cloths[0].ks == ks);
}

TEST_CASE("what is undoable is undone to the bit, and redone") {
  Timeline timeline = Make();
  Steps(timeline, 10);
  const std::uint64_t before = timeline.Hash();
  Command ball = Of(Command::Kind::Ball, 5);
  ball.undoable = true;
  ball.ball = {{0.5, 1.2, 0.5}, {0, -3, 0}, 0.1, 20};
  timeline.Execute(std::move(ball));
  const std::uint64_t after = Steps(timeline, 15).hash;
  Command undo = Of(Command::Kind::Restore, 6);
  undo.undoable = true;
  undo.before = 5;
  CHECK(timeline.Execute(std::move(undo)).hash == before);
  CHECK(timeline.world().balls().empty());
  Command redo = Of(Command::Kind::Restore, 7);
  redo.before = 6;
  const Executed redone = timeline.Execute(std::move(redo));
  CHECK(redone.hash == after);
  CHECK(redone.frame == 25);
  CHECK(timeline.world().balls().size() == 1);
  Command stale = Of(Command::Kind::Restore, 8);
  stale.before = 4;
  CHECK_FALSE(timeline.Execute(std::move(stale)).failure.empty());
}

TEST_CASE("a hand that holds on to a cloth that is gone holds nothing") {
  Timeline timeline = Make();
  timeline.Execute(
      {.kind = Command::Kind::Handles, .handles = {{0, 500, {}, 0.1, 50}, {3, 0, {}, 0.1, 50}, {0, 7, {}, 0.1, 50}}});
  CHECK(timeline.world().handles().size() == 1);
  auto scene = std::make_unique<Scene>(timeline.world().scene());
  scene->cloths[0].numWidthPoints = 5;
  scene->cloths[0].pinned.clear();
  timeline.Execute({.kind = Command::Kind::Apply, .scene = std::move(scene)});
  CHECK(timeline.world().handles().empty());
  Steps(timeline, 2);
}
