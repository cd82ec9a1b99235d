#include "world/divergence.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "percale/parameters.h"
#include "tests/springs/scenes.h"
#include "world/limits.h"

using namespace percale;
using namespace percale::test;

namespace {

/// The assignments PATH=VALUE that a remedy names.
std::vector<std::string> AssignmentsIn(const std::string& remedy) {
  std::vector<std::string> assignments;
  for (std::size_t at = remedy.find('='); at != std::string::npos; at = remedy.find('=', at + 1)) {
    const std::size_t begin = remedy.rfind(' ', at) + 1;
    std::size_t end = remedy.find_first_of(", ", at);
    if (end == std::string::npos) end = remedy.size();
    assignments.push_back(remedy.substr(begin, end - begin));
  }
  return assignments;
}

/// Runs until it diverges and checks everything that holds then. Returns the frame, 0 for none.
int FrameOfDivergence(const Scene& scene, int frames) {
  World world(scene);
  for (int frame = 1; frame <= frames; ++frame) {
    const std::uint64_t good = world.StateHash();
    const int goodFrame = world.report().frame;
    if (!world.Step().divergence) continue;
    const Divergence divergence = *world.report().divergence;
    CHECK(divergence.step > std::int64_t{frame - 1} * scene.simulation.stepsPerFrame);
    CHECK(divergence.step <= std::int64_t{frame} * scene.simulation.stepsPerFrame);
    REQUIRE(divergence.cloth >= 0);
    REQUIRE(divergence.cloth < world.ClothCount());
    CHECK(divergence.vertex >= 0);
    CHECK(divergence.vertex < static_cast<int>(world.Cloth(divergence.cloth).positions().size()));
    CHECK_FALSE(divergence.cause.empty());
    CHECK_FALSE(divergence.remedy.empty());
    // The reader has the last good frame, and further steps do nothing.
    CHECK(world.StateHash() == good);
    CHECK(world.report().frame == goodFrame);
    CHECK(AllFinite(world));
    const std::int64_t step = world.report().step;
    Run(world, 3);
    CHECK(world.StateHash() == good);
    CHECK(world.report().step == step);
    REQUIRE(world.report().divergence);
    CHECK(world.report().divergence->step == divergence.step);
    return frame;
  }
  return 0;
}

}  // namespace

TEST_CASE("density 1 g/cm^2 with ks 1e5 blows up within three frames; each remedy cures it") {
  Scene scene = CourseScene("pinned2");
  scene.cloths[0].density = 10;
  scene.cloths[0].ks = 1e5;
  const int frame = FrameOfDivergence(scene, 10);
  CHECK(frame >= 1);
  CHECK(frame <= 3);

  World world(scene);
  while (!world.Step().divergence) REQUIRE(world.report().frame < 10);
  const Divergence divergence = *world.report().divergence;
  CHECK(divergence.cause.find("cloth.ks") != std::string::npos);
  const std::vector<std::string> remedies = AssignmentsIn(divergence.remedy);
  REQUIRE(remedies.size() == 2);
  for (const std::string& remedy : remedies) {
    CAPTURE(remedy);
    Scene cured = scene;
    REQUIRE(ApplyAssignment(cured, remedy));
    CHECK_FALSE(HasErrors(CheckScene(cured)));
    CHECK(FrameOfDivergence(cured, Frames(60)) == 0);
  }

  // A World that has diverged starts again, with other settings or the same.
  scene.cloths[0].ks = 5000;
  world.Apply(scene);
  world.Reset();
  CHECK_FALSE(world.report().divergence);
  Run(world, 10);
  World fresh(scene);
  Run(fresh, 10);
  CHECK(world.report().frame == 10);
  CHECK(world.StateHash() == fresh.StateHash());
}

TEST_CASE("one step per frame at the course's values blows up within 30 frames") {
  Scene scene = CourseScene("pinned2");
  scene.simulation.stepsPerFrame = 1;
  const int frame = FrameOfDivergence(scene, 40);
  CHECK(frame >= 2);
  CHECK(frame <= 30);
}

TEST_CASE("what is stable does not diverge") {
  for (const char* name : kCourseScenes) CHECK(FrameOfDivergence(CourseScene(name, 20), Frames(100)) == 0);
  Scene scene = CourseScene("pinned2");
  scene.cloths[0].ks = 0.95 * LargestStableKs(scene.cloths[0], scene.TimeStep());
  CHECK(FrameOfDivergence(scene, Frames(100)) == 0);
}

TEST_CASE("a cloth that falls for ever stops at the bound, and says so") {
  Scene scene = SmallScene(3, 3);
  scene.simulation.gravity = {0, -1e6, 0};
  scene.cloths[0].damping = 0;
  World world(scene);
  for (int frame = 0; frame < 300 && !world.Step().divergence; ++frame) CHECK(AllFinite(world));
  REQUIRE(world.report().divergence);
  CHECK(world.report().divergence->cause.find("bounds") != std::string::npos);
  CHECK(AllFinite(world));
}

TEST_CASE("of several cloths the one that is lost is named") {
  Scene scene = SmallScene(4, 4);
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].origin.x = 10;
  scene.cloths[1].pinned = {{0, 0}};
  scene.cloths[1].density = 0.1;
  scene.cloths[1].ks = 1e5;
  World world(scene);
  Run(world, 30);
  REQUIRE(world.report().divergence);
  CHECK(world.report().divergence->cloth == 1);
  CHECK(world.report().divergence->cause.find("cloth.1.ks") != std::string::npos);
}

TEST_CASE("the limits are those of the contract") {
  const ClothSettings course = CourseScene("pinned2").cloths[0];
  const double dt = 1.0 / 2700;
  CHECK(PointMass(course) == doctest::Approx(0.06));
  CHECK(LargestStableKs(course, dt) == doctest::Approx(2.187e5).epsilon(1e-6));
  CHECK(LargestSensibleThickness(course) == doctest::Approx(0.5 / 49));
  ClothSettings light = course;
  light.density = 0;
  CHECK(std::isinf(LargestStableKs(light, dt)));
  // With the fewest stable steps ks is stable, with one fewer it is not.
  for (const double ks : {1e3, 1e5, 1e6, 3e7}) {
    ClothSettings cloth = course;
    cloth.ks = ks;
    const int steps = SmallestStableStepsPerFrame(cloth, 90);
    CHECK(LargestStableKs(cloth, 1.0 / (90.0 * steps)) > ks);
    if (steps > 1) CHECK(LargestStableKs(cloth, 1.0 / (90.0 * (steps - 1))) <= ks);
  }
}
