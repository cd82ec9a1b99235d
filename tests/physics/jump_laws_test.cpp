// Colliders that jump, and those that only go fast.

#include <doctest/doctest.h>

#include <cstdint>

#include "percale/fabrics.h"
#include "percale/intersections.h"
#include "percale/world.h"
#include "physics/body.h"

using namespace percale;

namespace {

constexpr double kJump = 0.1;  // [s]

/// A cotton sheet that hangs at z = 0 from one edge, and a collider before it, which goes through to behind it
/// at `kJump`.
Scene Curtain(ColliderSettings collider) {
  Scene scene = test::SheetScene(Fabric::Cotton, 0.6, 0.6, 18, 18);
  ClothSettings& sheet = scene.cloths[0];
  sheet.rotation = {90, 0, 0};
  sheet.origin = {-0.3, 0, -0.3};
  for (int i = 0; i < 19; ++i) sheet.pinned.push_back({i, 0});
  collider.position = {0, 1, 0.2};
  scene.colliders.push_back(collider);
  scene.colliderMotions.push_back({.start = 0, .end = kJump, .displacement = {0, 0, -0.2 + 0.03}, .jump = true});
  return scene;
}

ColliderSettings Box() {
  ColliderSettings box;
  box.shape = ColliderShape::Box;
  box.size = {0.12, 0.12, 0.12};
  box.rotation = {20, 30, 10};
  return box;
}

ColliderSettings Tube() {
  ColliderSettings tube = test::Body([](const Vec3& x, double) { return x; }, 0, 1);
  tube.cache.clear();
  return tube;
}

}  // namespace

TEST_CASE("a collider that jumps into cloth is there at once, and flagged; what it went through is pulled out") {
  const bool box = [] {
    bool is = false;
    SUBCASE("a box") {
      is = true;
    }
    SUBCASE("a mesh") {}
    return is;
  }();
  World world(Curtain(box ? Box() : Tube()), {.threads = 1});
  std::int64_t jumps = 0, most = 0, last = 0;
  for (int frame = 1; frame <= 100; ++frame) {
    CAPTURE(frame);
    const StepReport& report = world.Step();
    REQUIRE(!report.divergence);
    jumps += report.jumps;
    if (jumps == 0) CHECK(report.intersections == 0);
    if (report.jumps > 0) CHECK(report.time == doctest::Approx(kJump).epsilon(0.2));
    most = std::max(most, report.intersections);
    last = report.intersections;
    CHECK(ClothJudge(world, 1).Count(world).count == 0);
  }
  CHECK(jumps == 1);
  CHECK(most >= 4);
  CHECK(last == 0);
}

TEST_CASE("a collider that is not said to jump sweeps cloth along, however fast it goes") {
  for (const bool box : {true, false}) {
    Scene scene = Curtain(box ? Box() : Tube());
    scene.colliderMotions[0].jump = false;
    scene.colliderMotions[0].start = 0.99 * kJump;
    World world(scene, {.threads = 1});
    for (int frame = 0; frame < 20; ++frame) {
      const StepReport& report = world.Step();
      REQUIRE(!report.divergence);
      CHECK(report.jumps == 0);
      CHECK(report.intersections == 0);
    }
  }
}

TEST_CASE("before and after a jump a state goes on to the same bits") {
  for (const int frames : {4, 9}) {
    CAPTURE(frames);
    World world(Curtain(Box()), {.threads = 1});
    for (int frame = 0; frame < frames; ++frame) world.Step();
    WorldState state;
    world.Save(state);
    const std::uint64_t hash = test::HashAfter(world, 8);
    World other(Curtain(Box()), {.threads = 3});
    other.Restore(state);
    CHECK(test::HashAfter(other, 8) == hash);
  }
}
