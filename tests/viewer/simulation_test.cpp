// The simulation on its thread, without a window.
#include "apps/viewer/simulation.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "percale/parameters.h"

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
  REQUIRE_FALSE(HasErrors(CheckScene(scene)));
  return scene;
}

/// Waits until command `number` is carried out; returns what came of it.
Executed WaitFor(Simulation& simulation, Snapshot& snapshot, std::uint64_t number) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    if (simulation.TakeSnapshot(snapshot)) {
      for (const Executed& done : snapshot.executed) {
        if (done.command == number) return done;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  FAIL("the command was not carried out");
  return {};
}

std::uint64_t Apply(Simulation& simulation, const Scene& scene) {
  return simulation.Send({.kind = Command::Kind::Apply, .scene = std::make_unique<Scene>(scene)});
}
std::uint64_t Steps(Simulation& simulation, int frames) {
  return simulation.Send({.kind = Command::Kind::Step, .frames = frames});
}
std::uint64_t Send(Simulation& simulation, Command::Kind kind) {
  return simulation.Send({.kind = kind});
}

std::uint64_t HashAfter(const Scene& scene, int frames) {
  World world(scene, {.threads = 1});
  for (int i = 0; i < frames; ++i) world.Step();
  return world.StateHash();
}

}  // namespace

TEST_CASE("it starts paused, with the start's state at hand") {
  const Scene scene = SmallScene();
  Simulation simulation(scene, {.threads = 1, .hashes = true});
  Snapshot snapshot;
  REQUIRE(simulation.TakeSnapshot(snapshot));
  CHECK_FALSE(snapshot.running);
  CHECK(snapshot.report.frame == 0);
  CHECK(snapshot.hash == HashAfter(scene, 0));
  REQUIRE(snapshot.cloths.size() == 1);
  CHECK(snapshot.cloths[0].positions.size() == 144);
  CHECK(snapshot.cloths[0].topology->springs.size() > 144);
  CHECK_FALSE(simulation.TakeSnapshot(snapshot));
}

TEST_CASE("steps, reset and settings give what a World gives") {
  Scene scene = SmallScene();
  Simulation simulation(scene, {.threads = 1, .hashes = true});
  Snapshot snapshot;
  Executed done = WaitFor(simulation, snapshot, Steps(simulation, 3));
  CHECK(done.frame == 3);
  CHECK(done.hash == HashAfter(scene, 3));
  CHECK(snapshot.hash == done.hash);
  REQUIRE(snapshot.reports.size() == 3);  // none is lost, though no picture showed the first two
  for (int i = 0; i < 3; ++i) CHECK(snapshot.reports[static_cast<std::size_t>(i)].frame == i + 1);
  CHECK(snapshot.cloths[0].velocities.size() == 144);

  World world(scene, {.threads = 1});
  for (int i = 0; i < 3; ++i) world.Step();
  scene.cloths[0].ks = 100;
  world.Apply(scene);
  world.Step();
  done = WaitFor(simulation, snapshot, Apply(simulation, scene));
  CHECK(done.stateKept);
  CHECK(snapshot.scene->cloths[0].ks == 100);
  done = WaitFor(simulation, snapshot, Steps(simulation, 1));
  CHECK(done.hash == world.StateHash());

  done = WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Reset));
  CHECK_FALSE(done.stateKept);
  CHECK(done.frame == 0);
  CHECK(done.hash == HashAfter(scene, 0));

  scene.cloths[0].numWidthPoints = 8;
  scene.cloths[0].pinned.clear();
  done = WaitFor(simulation, snapshot, Apply(simulation, scene));
  CHECK_FALSE(done.stateKept);
  CHECK(snapshot.cloths[0].positions.size() == 96);
  CHECK(snapshot.cloths[0].topology->uv.size() == 96);
}

TEST_CASE("of settings that wait the newest alone acts, and order is kept") {
  Scene scene = SmallScene();
  Simulation simulation(scene, {.threads = 1, .hashes = true});
  Snapshot snapshot;
  Steps(simulation, 40);  // Long enough for the others to queue up.
  std::uint64_t last = 0;
  for (int ks = 1; ks <= 50; ++ks) {
    scene.cloths[0].ks = ks;
    last = Apply(simulation, scene);
  }
  WaitFor(simulation, snapshot, last);
  CHECK(snapshot.scene->cloths[0].ks == 50);
  CHECK(snapshot.report.frame == 40);
}

TEST_CASE("springs that are switched off leave the copies") {
  Scene scene = SmallScene();
  Simulation simulation(scene, {.threads = 1});
  Snapshot snapshot;
  REQUIRE(simulation.TakeSnapshot(snapshot));
  const auto before = snapshot.cloths[0].topology;
  WaitFor(simulation, snapshot, Apply(simulation, scene));
  CHECK(snapshot.cloths[0].topology == before);  // Nothing has changed: the same copy.
  scene.cloths[0].enableShearing = false;
  WaitFor(simulation, snapshot, Apply(simulation, scene));
  CHECK(snapshot.cloths[0].topology->springs.size() == before->springs.size() - 2 * 11 * 11);
}

TEST_CASE("it runs in real time and pauses") {
  Scene scene = SmallScene();
  scene.simulation.framesPerSecond = 50;
  scene.simulation.stepsPerFrame = 2;
  std::atomic<int> told{0};
  Simulation simulation(scene, {.threads = 1, .hashes = true, .onSnapshot = [&] { ++told; }});
  Snapshot snapshot;
  const auto begin = std::chrono::steady_clock::now();
  WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Run));
  while (snapshot.report.frame < 20) {
    simulation.TakeSnapshot(snapshot);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  CHECK(time.count() > 18 / 50.0);  // Never faster than the scene says.
  CHECK(told > 20);
  WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Pause));
  CHECK_FALSE(snapshot.running);
  const int frame = snapshot.report.frame;
  CHECK(snapshot.hash == HashAfter(scene, frame));
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  CHECK_FALSE(simulation.TakeSnapshot(snapshot));
}

TEST_CASE("a divergence pauses it until the reset") {
  Scene scene = SmallScene();
  scene.cloths[0].ks = 1e9;
  Simulation simulation(scene, {.threads = 1, .hashes = true});
  Snapshot snapshot;
  Send(simulation, Command::Kind::Run);
  for (int i = 0; i < 60000 && !snapshot.report.divergence; ++i) {
    simulation.TakeSnapshot(snapshot);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  REQUIRE(snapshot.report.divergence);
  CHECK_FALSE(snapshot.running);
  for (const Vec3& p : snapshot.cloths[0].positions) CHECK(IsFinite(p));
  WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Run));
  CHECK_FALSE(snapshot.running);
  scene.cloths[0].ks = 100;
  Apply(simulation, scene);
  WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Reset));
  CHECK_FALSE(snapshot.report.divergence);
  CHECK(WaitFor(simulation, snapshot, Steps(simulation, 2)).hash == HashAfter(scene, 2));
}

TEST_CASE("it ends whatever it is doing") {
  for (int i = 0; i < 20; ++i) {
    Simulation simulation(SmallScene(), {.threads = 1});
    Send(simulation, Command::Kind::Run);
    Steps(simulation, 5);
  }
}

TEST_CASE("it loops through the history, and goes on from where it is paused") {
  const Scene scene = SmallScene();
  Simulation simulation(scene, {.threads = 1, .hashes = true, .historyBudget = std::size_t{1} << 24});
  Snapshot snapshot;
  WaitFor(simulation, snapshot, Steps(simulation, 6));
  CHECK(snapshot.history.lastFrame == 6);
  WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Loop));
  CHECK(snapshot.looping);
  bool seen[7] = {};
  for (int i = 0; i < 60000 && !(seen[0] && seen[3] && seen[6]); ++i) {
    simulation.TakeSnapshot(snapshot);
    REQUIRE(snapshot.report.frame <= 6);
    CHECK(snapshot.hash == HashAfter(scene, snapshot.report.frame));
    seen[snapshot.report.frame] = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  WaitFor(simulation, snapshot, Send(simulation, Command::Kind::Pause));
  CHECK_FALSE(snapshot.looping);
  WaitFor(simulation, snapshot, simulation.Send({.kind = Command::Kind::Seek, .frame = 2}));
  CHECK(snapshot.hash == HashAfter(scene, 2));
  const Executed done = WaitFor(simulation, snapshot, Steps(simulation, 1));
  CHECK(done.hash == HashAfter(scene, 3));
  CHECK(snapshot.history.lastFrame == 3);
}

TEST_CASE("of places to seek, and of handles, that wait the newest alone acts, unless it is to be undone") {
  Simulation simulation(SmallScene(), {.threads = 1, .hashes = true, .historyBudget = std::size_t{1} << 24});
  Snapshot snapshot;
  Steps(simulation, 40);
  std::uint64_t last = 0;
  for (int frame = 1; frame <= 30; ++frame) last = simulation.Send({.kind = Command::Kind::Seek, .frame = frame});
  WaitFor(simulation, snapshot, last);
  CHECK(snapshot.report.frame == 30);
  Steps(simulation, 40);
  const std::vector<Handle> handles = {{0, 5, {0, 1, 0}, 0.2, 50}};
  const auto first = simulation.Send({.kind = Command::Kind::Handles, .undoable = true, .handles = handles});
  last = simulation.Send({.kind = Command::Kind::Handles, .handles = {}});
  const auto restored = simulation.Send({.kind = Command::Kind::Restore, .before = first});
  CHECK(WaitFor(simulation, snapshot, restored).failure.empty());
}

TEST_CASE("snapshots tell the forces of contact where they are wanted, at once even while paused") {
  Scene scene = SmallScene();
  scene.simulation.engine = Engine::Fabric;
  scene.cloths[0].pinned.clear();
  scene.cloths[0].contactDistance = 0.01;
  scene.simulation.framesPerSecond = 60;
  scene.simulation.stepsPerFrame = 1;
  scene.planes.push_back({.point = {0, 0.9902, 0}, .normal = {0, 1, 0}, .friction = 0.5});
  Simulation simulation(scene, {.threads = 1});
  Snapshot snapshot;
  WaitFor(simulation, snapshot, Steps(simulation, 60));
  CHECK(snapshot.contacts.empty());
  simulation.WantContacts(true);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!simulation.TakeSnapshot(snapshot) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(snapshot.report.frame == 60);
  CHECK(snapshot.contacts.size() == 144);
  simulation.WantContacts(false);
  WaitFor(simulation, snapshot, Steps(simulation, 1));
  CHECK(snapshot.contacts.empty());
}
