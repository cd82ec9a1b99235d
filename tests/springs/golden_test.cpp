// The same scene gives the same bits with any number of threads, optimisation and compiler. The
// constants were computed once, with g++ and one thread; they change only when the rules do.

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

struct Golden {
  const char* scene;
  std::uint64_t hash;
};
constexpr Golden kGolden[] = {
    {"pinned2", 0x816a2326949b03cfu}, {"pinned4", 0xadeaf2f94cfad74fu},       {"sphere", 0xea192b7759464e27u},
    {"plane", 0x17aaca7cf76dcc66u},   {"selfCollision", 0x0fe3f3550253f466u},
};

}  // namespace

TEST_CASE("golden hash of every course scene after 100 frames, for 1, 2, 3 and 8 threads") {
  static_assert(std::numeric_limits<double>::is_iec559);
  for (const Golden& golden : kGolden) {
    for (const int threads : {1, 2, 3, 8}) {
      if (kSanitized && (threads > 2 || std::string(golden.scene).starts_with("p"))) continue;  // they are slow
      CAPTURE(std::string(golden.scene));
      CAPTURE(threads);
      World world(CourseScene(golden.scene), {.threads = threads});
      Run(world, 100);
      CHECK(world.StateHash() == golden.hash);
    }
  }
}

TEST_CASE("a scene of 150 x 150 points gives the same bits with any number of threads") {
  World one(CourseScene("selfCollision", 150), {.threads = 1});
  Run(one, Frames(12));
  for (const int threads : {2, 3, 8}) {
    CAPTURE(threads);
    World many(CourseScene("selfCollision", 150), {.threads = threads});
    Run(many, Frames(12));
    CHECK(many.StateHash() == one.StateHash());
    CHECK(many.report().elasticEnergy == one.report().elasticEnergy);
  }
}
