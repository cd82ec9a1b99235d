// What spheres, planes and the thickness of cloth do to points, seen stage by stage.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "springs/kernels.h"
#include "springs/springs_engine.h"
#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// Runs a scene's engine and calls seen(before, x, previous) around every Collide stage.
template <class Seen>
void WatchCollide(const Scene& scene, int steps, Seen&& seen) {
  const std::vector<ClothModel> models{MakeGrid(scene.cloths[0])};
  const Executor executor(1);
  springs::SpringsEngine engine(scene, models, executor, springs::BestKernels());
  const std::size_t count = models[0].start.size();
  std::vector<Vec3> before(count), x(count), previous(count);
  for (int step = 1; step <= steps; ++step) {
    engine.MoveColliders(step * scene.TimeStep());
    REQUIRE(engine.ApplyForces(step * scene.TimeStep()));
    engine.FindContacts();
    engine.SelfCollide();
    engine.ReadState(0, before, previous);
    engine.Collide();
    engine.ReadState(0, x, previous);
    for (std::size_t v = 0; v < count; ++v) seen(before[v], x[v], previous[v]);
    engine.LimitStrain();
  }
}

}  // namespace

TEST_CASE("a sphere without friction puts points onto its surface; with full friction they stay") {
  for (const double friction : {0.0, 0.3, 1.0}) {
    CAPTURE(friction);
    Scene scene = CourseScene("sphere", 20);
    scene.spheres[0].friction = friction;
    const Vec3 o = scene.spheres[0].origin;
    const double r = scene.spheres[0].radius;
    int hits = 0;
    WatchCollide(scene, 60 * 30, [&](const Vec3& before, const Vec3& x, const Vec3& previous) {
      if (Length(before - o) > r) {
        REQUIRE(x == before);
        return;
      }
      ++hits;
      const Vec3 target = o + r * UnitOr(before - o, {0, 1, 0});
      REQUIRE(Length(x - previous - (1 - friction) * (target - previous)) < 1e-14);
      if (friction == 0) REQUIRE(std::abs(Length(x - o) - r) < 1e-14);
      if (friction == 1) REQUIRE(x == previous);
    });
    CHECK(hits > 100);
  }
}

TEST_CASE("a point on the sphere's surface counts as touching, one outside does not") {
  Scene scene = SmallScene(2, 2);
  scene.cloths[0].density = 0;
  scene.cloths[0].thickness = 0;
  scene.spheres = {{{0, 0.5, 0}, 0.5, 0}};  // touches point (0, 0) from below
  World world(scene);
  world.Step();
  CHECK(world.report().colliderContacts == 30);
  CHECK(Length(world.Cloth(0).positions()[0] - Vec3{0, 1, 0}) < 1e-15);
}

TEST_CASE("no point ends a step's collisions on the other side of a plane, whatever the response") {
  for (const PlaneResponse response : {PlaneResponse::Interpolate, PlaneResponse::Offset, PlaneResponse::Hold}) {
    for (const double friction : {0.0, 0.5, 1.0}) {
      CAPTURE(static_cast<int>(response));
      CAPTURE(friction);
      Scene scene = CourseScene("selfCollision", 16);
      scene.simulation.planeResponse = response;
      scene.planes[0] = {{0, -0.05, 0}, {0.3, 2, 0.1}, friction};
      const Vec3 normal = UnitOr(scene.planes[0].normal, {});
      const auto height = [&](const Vec3& p) { return Dot(p - scene.planes[0].point, normal); };
      int hits = 0;
      WatchCollide(scene, 90 * 30, [&](const Vec3& before, const Vec3& x, const Vec3& previous) {
        REQUIRE((height(x) >= 0) == (height(previous) >= 0));
        if (x == before) return;
        ++hits;
        if (response == PlaneResponse::Hold || friction == 1) REQUIRE(x == previous);
        if (response == PlaneResponse::Hold || friction > 0) return;
        // Without friction: 0.1 mm from the plane.
        REQUIRE(std::abs(std::abs(height(x)) - 1e-4) < 1e-12);
      });
      CHECK(hits > 100);
    }
  }
}

TEST_CASE("a plane holds from either side, and its normal's length makes no difference") {
  std::uint64_t hashes[2];
  for (int k : {0, 1}) {
    Scene scene = SmallScene(6, 6);
    scene.simulation.gravity = {0, 9.8, 0};  // up, against a ceiling whose normal points up as well
    scene.planes = {{{0, 1.5, 0}, {0, k == 0 ? 1.0 : 8.0, 0}, 0.5}};
    World world(scene);
    Run(world, 120);
    CHECK(HighestY(world) < 1.5);
    CHECK(HighestY(world) > 1.49);
    hashes[k] = world.StateHash();
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("interpolate and offset keep a resting cloth moving, hold does not") {
  double moves[3], energies[3];
  for (const PlaneResponse response : {PlaneResponse::Interpolate, PlaneResponse::Offset, PlaneResponse::Hold}) {
    Scene scene = CourseScene("plane", 16);
    scene.simulation.planeResponse = response;
    World world(scene);
    Run(world, 250);
    double& move = moves[static_cast<std::size_t>(response)] = 0;
    double& energy = energies[static_cast<std::size_t>(response)] = 0;
    for (int frame = 0; frame < 50; ++frame) {
      world.Step();
      move = std::max(move, world.report().greatestMove);
      energy = std::max(energy, world.report().kineticEnergy);
    }
    CHECK(LowestY(world) >= 0);
    CHECK(HighestY(world) < 2e-3);
  }
  CHECK(moves[0] > 1e-5);
  CHECK(moves[0] < 2e-3);  // it bounces by about a millimetre
  CHECK(moves[1] > 1e-5);
  CHECK(moves[1] < 2e-3);
  CHECK(moves[2] == 0);
  CHECK(energies[2] < 1e-2 * energies[0]);
}

TEST_CASE("two layers of cloth stay two, each as thick as it is") {
  double gaps[2];
  for (const bool selfCollision : {false, true}) {
    Scene scene = SmallScene(10, 10);
    scene.planes = {{{0, 0.8, 0}, {0, 1, 0}, 0.5}};
    scene.simulation.planeResponse = PlaneResponse::Hold;
    scene.simulation.selfCollision = selfCollision;
    scene.cloths[0].thickness = 0.03;
    scene.cloths.push_back(scene.cloths[0]);
    scene.cloths[1].origin.y = 0.2;
    scene.cloths[1].thickness = 0.015;
    World world(scene);
    double& gap = gaps[selfCollision ? 1 : 0] = 0;
    // The push that parts them makes them bounce, so the mean over a while counts.
    Run(world, 150);
    for (int frame = 0; frame < 150; ++frame) {
      world.Step();
      const auto lower = world.Cloth(0).positions(), upper = world.Cloth(1).positions();
      for (std::size_t v = 0; v < lower.size(); ++v) gap += (upper[v].y - lower[v].y) / (150.0 * 100);
    }
    CHECK(LowestY(world) >= 0.8);
  }
  CHECK(gaps[0] < 1e-3);   // they fall into one without it
  CHECK(gaps[1] > 0.045);  // the sum of the two
  CHECK(gaps[1] < 0.2);
}
