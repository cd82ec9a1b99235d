// A warmed-up step does not allocate, whatever the cloth does meanwhile.

#include <doctest/doctest.h>

#include <vector>

#include "core/executor.h"
#include "mesh/cloth_model.h"
#include "springs/kernels.h"
#include "springs/springs_engine.h"
#include "tests/count_allocations.h"
#include "tests/springs/scenes.h"
#include "world/measure.h"

using namespace percale;
using namespace percale::test;

TEST_CASE("the counter counts") {
  std::vector<int>* kept = nullptr;
  CHECK(CountAllocations([&] { kept = new std::vector<int>(100); }) == 2);
  delete kept;
}

TEST_CASE("a warmed-up frame does not allocate") {
  std::vector<Scene> scenes;
  for (const char* name : kCourseScenes) scenes.push_back(CourseScene(name, 40));
  for (const HashFunction hash : {HashFunction::Linear, HashFunction::Powers, HashFunction::Brute}) {
    scenes.push_back(CourseScene("selfCollision", 20));
    scenes.back().simulation.hash = hash;
  }
  scenes.push_back(CourseScene("pinned2", 30));
  scenes.back().wind = {{1, 2, 3}, 1, 0.5, 1};
  scenes.back().pinMotions.push_back({0, {}, 0, 1, {0.2, 0.2, 0}});
  scenes.push_back(CourseScene("selfCollision", 30));
  scenes.back().cloths.push_back(CourseScene("sphere", 20).cloths[0]);

  for (std::size_t s = 0; s < scenes.size(); ++s) {
    CAPTURE(s);
    World world(scenes[s], {.threads = 1});
    world.Step();
    int contacts = 0;
    CHECK(CountAllocations([&] {
            for (int frame = 0; frame < Frames(90); ++frame) {
              const StepReport& report = world.Step();
              contacts += report.selfContacts + report.colliderContacts + report.limitedSprings > 0;
            }
          }) == 0);
    if (!kSanitized) CHECK(contacts > 0);
    CHECK(CountAllocations([&] { world.Reset(); }) == 0);
  }
}

TEST_CASE("measuring does not allocate once it is warm") {
  World world(CourseScene("selfCollision", 30), {.threads = 1});
  Run(world, Frames(90));
  const ClothView cloth = world.Cloth(0);
  const std::size_t count = cloth.positions().size();
  const ContactCloth contactCloth{cloth.positions(), cloth.rest(), world.scene().cloths[0].thickness};
  std::vector<double> a(count), b(count), ratios;
  CurvatureMeter curvature;
  ContactFinder contacts;
  const std::vector<PlacedSolid> solids = SolidsAt(world.scene(), world.report().time, world.balls());
  const auto measure = [&] {
    MeasureStretch(cloth.positions(), cloth.springs(), cloth.restLengths(), a, b);
    MeasureSpeed(cloth.velocities(), a);
    curvature.Measure(cloth.positions(), cloth.triangles(), a);
    contacts.Find({&contactCloth, 1}, solids);
    ratios.clear();
    AppendStretch(cloth.positions(), cloth.springs(), cloth.restLengths(), ratios);
    Percentile(ratios, 0.99);
  };
  measure();
  CHECK(CountAllocations(measure) == 0);
}

TEST_CASE("no stage of the engine allocates") {
  const Scene scene = CourseScene("selfCollision", 40);
  const std::vector<ClothModel> models{MakeGrid(scene.cloths[0])};
  const Executor executor(1);
  springs::SpringsEngine engine(scene, models, executor, springs::BaselineKernels());
  CHECK(CountAllocations([&] {  // not even in the first step
          for (int step = 1; step <= 900; ++step) {
            engine.MoveColliders(step * scene.TimeStep());
            engine.ApplyForces(step * scene.TimeStep());
            engine.FindContacts();
            engine.SelfCollide();
            engine.Collide();
            engine.LimitStrain();
          }
        }) == 0);
  CHECK(engine.TakeCounts().selfContacts > 0);
}
