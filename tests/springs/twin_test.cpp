// The engine holds the rules to the last bit: equal to the plain twin, which walks points and
// springs one by one, in every corner of the settings.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "springs/kernels.h"
#include "springs/springs_engine.h"
#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// A sphere and two planes that a falling sheet of `SmallScene` meets.
void AddColliders(Scene& scene) {
  scene.spheres.push_back({{0.1, 0.9, 0.1}, 0.08, 0.3});
  scene.planes.push_back({{0, 0.85, 0}, {0.2, 1, 0}, 0.5});
}

/// A scene of 50 x 50 points in which all stages have work from the first frame on: the sheet is
/// dropped onto a sphere that it already touches, and folds.
Scene BusyScene() {
  Scene scene = CourseScene("selfCollision");
  scene.spheres.push_back({{0.5, 0.1, 0.02}, 0.15, 0.2});
  return scene;
}

}  // namespace

TEST_CASE("small and odd grids equal the plain twin") {
  const int sizes[][2] = {{2, 2}, {2, 7}, {7, 2}, {3, 3}, {5, 4}, {9, 17}, {64, 2}, {2, 64}, {8, 8}, {10, 3}, {17, 9}};
  for (const auto& size : sizes) {
    CAPTURE(size[0]);
    CAPTURE(size[1]);
    Scene scene = SmallScene(size[0], size[1]);
    AddColliders(scene);
    scene.cloths[0].pinned = {{size[0] - 1, size[1] - 1}};
    CHECK(RunBoth(scene, Fewer(60, 15)) == "");
    scene.cloths[0].orientation = Orientation::Vertical;
    scene.cloths[0].pinned.clear();
    CHECK(RunBoth(scene, Fewer(60, 15)) == "");
  }
}

TEST_CASE("every hash function with every plane response equals the plain twin") {
  for (const HashFunction hash :
       {HashFunction::Exact, HashFunction::Linear, HashFunction::Powers, HashFunction::Brute}) {
    for (const PlaneResponse response : {PlaneResponse::Interpolate, PlaneResponse::Offset, PlaneResponse::Hold}) {
      CAPTURE(static_cast<int>(hash));
      CAPTURE(static_cast<int>(response));
      Scene scene = CourseScene("selfCollision", 20);
      scene.simulation.hash = hash;
      scene.simulation.planeResponse = response;
      CHECK(RunBoth(scene, Frames(80)) == "");
    }
  }
}

TEST_CASE("every choice of spring kinds equals the plain twin") {
  for (int kinds = 0; kinds < 8; ++kinds) {
    CAPTURE(kinds);
    Scene scene = CourseScene("pinned2", 16);
    scene.cloths[0].enableStructural = kinds & 1;
    scene.cloths[0].enableShearing = kinds & 2;
    scene.cloths[0].enableBending = kinds & 4;
    CHECK(RunBoth(scene, Frames(90)) == "");
  }
}

TEST_CASE("pins anywhere equal the plain twin, and none of them moves") {
  Scene scene = SmallScene(7, 6);
  AddColliders(scene);
  scene.cloths[0].pinned = {{3, 2}, {3, 3}, {0, 5}, {6, 1}};
  CHECK(RunBoth(scene, Frames(100)) == "");
  World world(scene);
  const std::vector<Vec3> start(world.Cloth(0).positions().begin(), world.Cloth(0).positions().end());
  Run(world, 50);
  for (const std::int32_t pin : world.Cloth(0).pinned()) {
    CHECK(world.Cloth(0).positions()[static_cast<std::size_t>(pin)] == start[static_cast<std::size_t>(pin)]);
  }

  scene.cloths[0].pinned.clear();
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 7; ++i) scene.cloths[0].pinned.push_back({i, j});
  }
  CHECK(RunBoth(scene, 20) == "");
  World held(scene);
  Run(held, 20);
  for (std::size_t v = 0; v < start.size(); ++v) CHECK(held.Cloth(0).positions()[v] == start[v]);
}

TEST_CASE("several cloths of different thickness, spheres and planes in both orders equal the plain twin") {
  for (const bool planesFirst : {false, true}) {
    CAPTURE(planesFirst);
    Scene scene = SmallScene(9, 8);
    ClothSettings second = scene.cloths[0];
    second.origin = {0.04, 0.03, 0.02};
    second.numWidthPoints = 12;
    second.thickness = 0.01;
    second.density = 60;
    ClothSettings third = second;
    third.orientation = Orientation::Vertical;
    third.origin = {0.1, 0.9, 0.3};
    third.thickness = 0.03;
    third.numHeightPoints = 5;
    scene.cloths.push_back(second);
    scene.cloths.push_back(third);
    scene.spheres = {{{0.3, 0.8, 0.3}, 0.15, 0.3}, {{0.5, 0.75, 0.4}, 0.15, 0.9}};
    scene.planes = {{{0, 0.75, 0}, {0, 1, 0.1}, 0.5}, {{0.7, 0, 0}, {-3, 0.1, 0}, 0}, {{0, 2, 0}, {0, -1, 0}, 1}};
    scene.planesFirst = planesFirst;
    CHECK(RunBoth(scene, Frames(120)) == "");
  }
}

TEST_CASE("a cloth torn to many times its size, far from the origin, equals the plain twin") {
  for (const double way : {0.0, 3.0, 40.0}) {
    CAPTURE(way);
    Scene scene = CourseScene("pinned2", 21);
    scene.cloths[0].origin = {-900, 30, 4000};
    scene.pinMotions.push_back({0, {{20, 0}}, 0, 0.3, {way, 0.2 * way, 0}});
    CHECK(RunBoth(scene, Frames(60)) == "");
  }
}

TEST_CASE("the smallest and the largest cloths equal the plain twin") {
  for (const double size : {2e-8, 1e-4, 300.0}) {
    CAPTURE(size);
    Scene scene = CourseScene("pinned2", 12);
    scene.simulation.gravity = {0, -9.8 * size, 0};
    scene.cloths[0].width = scene.cloths[0].height = size;
    scene.cloths[0].origin = {0, 0, 0};
    scene.cloths[0].thickness = 1e-3 * size;
    scene.cloths[0].ks *= size * size;  // as the mass
    scene.pinMotions.push_back({0, {{11, 0}}, 0, 0.3, {0.5 * size, 0.2 * size, 0}});
    CHECK(RunBoth(scene, Frames(40)) == "");
  }
}

TEST_CASE("wind, pins that move, and the ends of damping equal the plain twin") {
  Scene windy = CourseScene("pinned2", 20);
  windy.wind = {{2, 0.5, 4}, 1.5, 0.5, 0.7};
  CHECK(RunBoth(windy, Frames(90)) == "");

  Scene moving = CourseScene("pinned4", 20);
  moving.pinMotions.push_back({0, {}, 0.05, 0.5, {0.1, 0.2, 0}});
  moving.pinMotions.push_back({0, {{0, 0}, {19, 19}}, 0.2, 0.9, {-0.3, 0, 0.2}});
  moving.wind = {{0, 3, 0}, 0.5, 1, 0.3};
  CHECK(RunBoth(moving, Frames(120)) == "");
  moving.pinMotions[0].angle = 500;
  moving.pinMotions[0].axis = {1, 2, 0};
  moving.pinMotions[0].centre = {0.5, 1, 0.5};
  moving.pinMotions[1].angle = -90;
  moving.pinMotions[1].steady = true;
  CHECK(RunBoth(moving, Frames(120)) == "");

  for (const double damping : {0.0, 100.0}) {
    CAPTURE(damping);
    Scene damped = CourseScene("sphere", 20);
    damped.cloths[0].damping = damping;
    CHECK(RunBoth(damped, Frames(90)) == "");
  }
}

TEST_CASE("settings that change while it runs equal the plain twin") {
  Scene scene = CourseScene("pinned2", 24);
  bench::PlainTwin twin(scene);
  World world(scene, {.threads = 2});
  const auto runOn = [&](const char* what) {
    CAPTURE(std::string(what));
    twin.SetScene(scene);
    REQUIRE(world.Apply(scene));
    for (int frame = 0; frame < Fewer(15, 3); ++frame) {
      twin.Frame();
      world.Step();
      REQUIRE(FirstDifference(twin, world) == "");
    }
  };
  runOn("nothing");
  scene.cloths[0].ks = 800;
  runOn("ks");
  scene.cloths[0].density = 40;
  runOn("density");
  scene.cloths[0].enableStructural = false;
  runOn("structural springs");
  scene.simulation.gravity = {3, -9, 1};
  runOn("gravity");
  scene.cloths[0].damping = 1;
  runOn("damping");
  scene.simulation.stepsPerFrame = 20;
  runOn("steps per frame");
  scene.cloths[0].thickness = 0.005;
  runOn("thickness");
  scene.spheres = {{{0.5, 0.6, 0.5}, 0.2, 0.1}};
  runOn("sphere");
  scene.wind = {{0, 0, 5}, 1, 0, 1};
  runOn("wind");
  scene.spheres.clear();
  scene.planes = {{{0, 0.5, 0}, {0, 1, 0}, 0.5}};
  runOn("plane for a sphere");
  scene.simulation.hash = HashFunction::Linear;
  runOn("hash function");
  scene.simulation.planeResponse = PlaneResponse::Hold;
  runOn("plane response");
  scene.pinMotions.push_back({0, {{0, 0}}, world.report().time, world.report().time + 0.2, {0.2, 0.1, 0}});
  runOn("pin motion");
  scene.simulation.selfCollision = false;
  scene.wind.drag = 0;
  runOn("self-collision");
}

TEST_CASE("sixty random scenes equal the plain twin") {
  SplitMix64 random(20240229);
  int moved = 0;
  for (int k = 0; k < Fewer(60, 20); ++k) {
    CAPTURE(k);
    const Scene scene = RandomScene(random);
    CHECK(RunBoth(scene, Frames(20), 1 + k % 3) == "");
    World world(scene);
    Run(world, 2);
    moved += world.report().kineticEnergy > 0;
  }
  CHECK(moved > Fewer(45, 12));
}

TEST_CASE("a sheet large enough to be shared among threads equals the plain twin") {
  Scene scene = CourseScene("selfCollision", 120);
  scene.cloths[0].numHeightPoints = 90;
  for (const int threads : {2, 3}) CHECK(RunBoth(scene, Frames(8), threads) == "");
}

TEST_CASE("kernels of all instruction sets give the same bits") {
  const Scene scene = BusyScene();
  const std::vector<ClothModel> models{MakeGrid(scene.cloths[0])};
  const Executor executor(1);
  springs::SpringsEngine best(scene, models, executor, springs::BestKernels());
  springs::SpringsEngine plain(scene, models, executor, springs::BaselineKernels());
  std::vector<Vec3> x[2], previous[2];
  for (int which : {0, 1}) {
    x[which].resize(models[0].start.size());
    previous[which].resize(models[0].start.size());
  }
  for (int step = 1; step <= Frames(60) * 30; ++step) {
    for (springs::SpringsEngine* engine : {&best, &plain}) {
      engine->MoveColliders(step * scene.TimeStep());
      REQUIRE(engine->ApplyForces(step * scene.TimeStep()));
      engine->FindContacts();
      engine->SelfCollide();
      engine->Collide();
      engine->LimitStrain();
    }
    if (step % 30 != 0) continue;
    best.ReadState(0, x[0], previous[0]);
    plain.ReadState(0, x[1], previous[1]);
    REQUIRE(x[0] == x[1]);
    REQUIRE(previous[0] == previous[1]);
  }
  const EngineCounts a = best.TakeCounts(), b = plain.TakeCounts();
  CHECK(a.selfContacts == b.selfContacts);
  CHECK(a.colliderContacts == b.colliderContacts);
  CHECK(a.limitedSprings == b.limitedSprings);
  CHECK(a.selfContacts > 0);
  CHECK(a.colliderContacts > 0);
  CHECK(a.limitedSprings > 0);
}
