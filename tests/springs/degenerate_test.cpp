// Settings and positions in which formulas have no value: no mass, no stiffness, no direction.

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

TEST_CASE("a cloth without mass: gravity, wind and springs do not act on it") {
  Scene scene = SmallScene(6, 6);
  scene.cloths[0].density = 0;
  scene.cloths[0].thickness = 0;
  scene.wind = {{5, 5, 5}, 2, 0, 1};
  CHECK(RunBoth(scene, 30) == "");
  World world(scene);
  const std::vector<Vec3> start(world.Cloth(0).positions().begin(), world.Cloth(0).positions().end());
  Run(world, 30);
  CHECK(AllFinite(world));
  CHECK(world.report().kineticEnergy == 0);
  for (std::size_t v = 0; v < start.size(); ++v) CHECK(world.Cloth(0).positions()[v] == start[v]);
}

TEST_CASE("ks 0: points fall freely, held by nothing but the strain limit") {
  Scene scene = CourseScene("pinned2", 12);
  scene.cloths[0].ks = 0;
  CHECK(RunBoth(scene, 120) == "");
  World world(scene);
  Run(world, 200);
  CHECK(AllFinite(world));
  CHECK_FALSE(world.report().divergence);
  CHECK(world.report().greatestStretch < 1.3);
  CHECK(LowestY(world) < 0.1);
}

TEST_CASE("thickness 0: points keep no distance, and nothing else changes") {
  Scene scene = CourseScene("selfCollision", 16);
  scene.cloths[0].thickness = 0;
  CHECK(RunBoth(scene, 100) == "");
  World with(scene);
  scene.simulation.selfCollision = false;
  World without(scene);
  Run(with, 60);
  Run(without, 60);
  CHECK(with.StateHash() == without.StateHash());
  CHECK(AllFinite(with));
}

TEST_CASE("points that coincide at the start part along +y") {
  Scene scene = SmallScene(4, 4);
  scene.simulation.gravity = {0, 0, 0};
  scene.cloths.push_back(scene.cloths[0]);  // in the very same place
  CHECK(RunBoth(scene, 60) == "");
  World world(scene);
  world.Step();
  CHECK(AllFinite(world));
  CHECK(world.report().selfContacts > 0);
  const std::span<const Vec3> first = world.Cloth(0).positions(), second = world.Cloth(1).positions();
  for (std::size_t v = 0; v < first.size(); ++v) {
    CAPTURE(v);
    CHECK(first[v].y > second[v].y);  // the first cloth's point is visited first, and goes up
    CHECK(first[v].x == doctest::Approx(second[v].x).epsilon(1e-3));
  }
  Run(world, 60);
  CHECK(AllFinite(world));
  CHECK_FALSE(world.report().divergence);
}

TEST_CASE("a pin moved onto a free point: a spring without length exerts no force") {
  Scene scene = SmallScene(2, 2);
  scene.cloths[0].width = scene.cloths[0].height = 1;  // so that coordinates are exact
  scene.cloths[0].pinned = {{0, 0}};
  scene.cloths[0].density = 0;
  scene.simulation.selfCollision = false;
  scene.pinMotions.push_back({0, {}, 0, 0.1, {1, 0, 0}});
  CHECK(RunBoth(scene, 40) == "");
  World world(scene);
  Run(world, 20);
  REQUIRE(world.Cloth(0).positions()[0] == world.Cloth(0).positions()[1]);
  CHECK(AllFinite(world));

  // With mass and self-collision the two part again, and go on.
  scene.cloths[0].density = 150;
  scene.simulation.selfCollision = true;
  CHECK(RunBoth(scene, 60) == "");
}

TEST_CASE("a point in the centre of a sphere leaves it upwards") {
  Scene scene = SmallScene(3, 3);
  scene.simulation.gravity = {0, 0, 0};
  scene.cloths[0].density = 0;  // it stays where it is put
  scene.cloths[0].thickness = 0;
  scene.spheres = {{{0.1, 1, 0.1}, 0.01, 0}};
  CHECK(RunBoth(scene, 2) == "");
  World world(scene);
  world.Step();
  CHECK(AllFinite(world));
  CHECK(world.Cloth(0).positions()[4].y >= 1.01 - 1e-12);
}

TEST_CASE("a sheet thicker than its spacing swells, but the numbers hold") {
  Scene scene = CourseScene("plane", 20);
  scene.cloths[0].thickness *= 3;
  CHECK(RunBoth(scene, 60) == "");
}
