// Forces of a program's own, in either engine.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "percale/fabrics.h"
#include "percale/interaction.h"
#include "percale/world.h"
#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// A sheet in free space; in the springs engine its points weigh the same each, in the fabric engine by their area.
Scene Floating(Engine engine, int stepsPerFrame = 3) {
  Scene scene = CourseScene("pinned2", 8);
  scene.simulation.engine = engine;
  scene.simulation.stepsPerFrame = stepsPerFrame;
  scene.simulation.gravity = {};
  scene.simulation.selfCollision = false;
  scene.cloths[0].pinned.clear();
  scene.cloths[0].damping = 0;
  if (engine == Engine::Fabric) SetFabric(scene.cloths[0], Fabric::Cotton);
  scene.wind.airDensity = 0;
  return scene;
}

/// The masses of a cloth's points [kg].
std::vector<double> Masses(const Scene& scene) {
  const World weighed(scene);
  const double area = scene.cloths[0].width * scene.cloths[0].height;
  const auto count = weighed.Cloth(0).positions().size();
  if (scene.simulation.engine == Engine::Springs)
    return std::vector<double>(count, scene.cloths[0].density * area / static_cast<double>(count));
  std::vector<double> masses(count, 0);
  const double triangle = scene.cloths[0].density * area / static_cast<double>(weighed.Cloth(0).triangles().size());
  for (const Triangle& t : weighed.Cloth(0).triangles()) {
    for (const std::int32_t v : {t.a, t.b, t.c}) masses[static_cast<std::size_t>(v)] += triangle / 3;
  }
  return masses;
}

double Farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double farthest = 0;
  for (std::size_t v = 0; v < a.size(); ++v) farthest = std::max(farthest, Length(a[v] - b[v]));
  return farthest;
}

}  // namespace

TEST_CASE("forces that are as great as weights do what gravity does") {
  for (const Engine engine : {Engine::Springs, Engine::Fabric}) {
    CAPTURE(static_cast<int>(engine));
    Scene scene = Floating(engine);
    const std::vector<double> masses = Masses(scene);
    scene.cloths[0].pinned = {{0, 0}, {7, 0}};
    World pulled(scene);
    const Vec3 g{1, -9.8, 0.5};
    pulled.SetForces([&](const ForceCall& call) {
      for (std::size_t v = 0; v < call.forces.size(); ++v) call.forces[v] = g * masses[v];
    });
    scene.simulation.gravity = g;
    World falling(scene);
    for (int frame = 0; frame < 20; ++frame) pulled.Step(), falling.Step();
    REQUIRE(!pulled.report().divergence);
    CHECK(Farthest(falling.Cloth(0).positions(), falling.Cloth(0).rest()) > 0.05);
    CHECK(Farthest(pulled.Cloth(0).positions(), falling.Cloth(0).positions()) < 1e-4);
    // Taken away, they act no more; Reset leaves them.
    pulled.Reset();
    CHECK(pulled.Step().kineticEnergy > 0);
    pulled.Reset();
    pulled.SetForces({});
    CHECK(pulled.Step().kineticEnergy == doctest::Approx(0));
  }
}

TEST_CASE("a function sees each step: its start in time, positions and velocities") {
  for (const Engine engine : {Engine::Springs, Engine::Fabric}) {
    CAPTURE(static_cast<int>(engine));
    Scene scene = Floating(engine, 4);
    scene.simulation.gravity = {0, -1, 0};
    World world(scene);
    std::vector<double> times;
    world.SetForces([&](const ForceCall& call) {
      REQUIRE(call.cloth == 0);
      REQUIRE((call.positions.size() == 64 && call.velocities.size() == 64 && call.forces.size() == 64));
      CHECK(call.velocities[5].y == doctest::Approx(-call.time).epsilon(1e-6));
      const double dt = scene.TimeStep();
      const double fallen = 0.5 * call.time * (call.time + dt);
      CHECK(call.positions[5].y - world.Cloth(0).rest()[5].y == doctest::Approx(-fallen).epsilon(1e-6));
      CHECK(call.forces[5] == Vec3{});
      times.push_back(call.time);
    });
    world.Step();
    world.Step();
    REQUIRE(times.size() == 8);
    for (std::size_t k = 0; k < times.size(); ++k) {
      CHECK(times[k] == doctest::Approx(static_cast<double>(k) * scene.TimeStep()));
    }
  }
}

TEST_CASE("a force that is no number, or beyond all bounds, is named, and the last good frame stays") {
  for (const Engine engine : {Engine::Springs, Engine::Fabric}) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
      CAPTURE(bad);
      World world(Floating(engine));
      world.SetForces([&](const ForceCall& call) { call.forces[17].z = call.time > 0.05 ? bad : 1e-3; });
      int frames = 0;
      std::uint64_t good = world.StateHash();
      while (!world.report().divergence && frames < 50) {
        good = world.StateHash();
        world.Step();
        ++frames;
      }
      REQUIRE(world.report().divergence);
      const Divergence& divergence = *world.report().divergence;
      CHECK((divergence.cloth == 0 && divergence.vertex == 17));
      CHECK(divergence.step == static_cast<std::int64_t>(std::floor(0.05 / world.scene().TimeStep())) + 2);
      CHECK(divergence.cause.find("force function gave (0, 0, ") != std::string::npos);
      CHECK(divergence.remedy.find("SetForces") != std::string::npos);
      CHECK(world.StateHash() == good);
      // From the start again, with a better function.
      world.Reset();
      world.SetForces({});
      CHECK(!world.Step().divergence);
    }
  }
}
