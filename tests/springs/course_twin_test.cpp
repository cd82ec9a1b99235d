// The course's scenes as they are, against the plain twin.

#include <doctest/doctest.h>

#include <string>

#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

TEST_CASE("five course scenes equal the plain twin to the last bit, with one thread and with two") {
  for (const char* name : kCourseScenes) {
    CAPTURE(std::string(name));
    const Scene scene = CourseScene(name);
    bench::PlainTwin twin(scene);
    World one(scene, {.threads = 1}), two(scene, {.threads = 2});
    for (int frame = 0; frame < Frames(300); ++frame) {
      twin.Frame();
      one.Step();
      two.Step();
      REQUIRE(FirstDifference(twin, one) == "");
      REQUIRE(FirstDifference(twin, two) == "");
    }
    // All of it is worth nothing if the sheet hung in the air.
    if (!kSanitized) CHECK(one.report().selfContacts + one.report().colliderContacts + one.report().limitedSprings > 0);
  }
}
