#include "apps/viewer/intersection_counter.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <thread>

using namespace percale;
using namespace percale::viewer;

namespace {

/// Two triangles, the second `height` above the first and upright: below 0 its corner passes through.
Snapshot TwoTriangles(double height, int frame) {
  auto one = std::make_shared<viewer::ClothTopology>();
  one->triangles = {{0, 1, 2}};
  one->rest.resize(3);
  Snapshot snapshot;
  snapshot.report.frame = frame;
  snapshot.cloths.resize(2);
  snapshot.cloths[0].positions = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
  snapshot.cloths[1].positions = {{0, height, 0}, {0.3, height + 1, 0}, {-0.3, height + 1, 0}};
  for (ClothCopy& cloth : snapshot.cloths) cloth.topology = one;
  return snapshot;
}

IntersectionCounter::Result WaitFor(const IntersectionCounter& counter, int frame) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  for (;;) {
    const auto result = counter.result();
    if (result && result->frame == frame) return *result;
    REQUIRE(std::chrono::steady_clock::now() < deadline);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

TEST_CASE("the counter tells what the judge counts, and of which frame") {
  std::atomic<int> woken = 0;
  IntersectionCounter counter([&] { ++woken; });
  CHECK_FALSE(counter.result());
  CHECK_FALSE(counter.TakeNews());
  Snapshot state = TwoTriangles(0.5, 3);
  counter.Offer(state);
  CHECK(WaitFor(counter, 3).count == 0);
  CHECK(counter.TakeNews());
  CHECK_FALSE(counter.TakeNews());

  state.report.frame = 4;
  for (Vec3& p : state.cloths[1].positions) p.y -= 1;
  counter.Offer(state);
  CHECK(WaitFor(counter, 4).count == 2);

  // Whatever comes in between, the newest is counted in the end.
  for (int frame = 5; frame < 200; ++frame) {
    state.report.frame = frame;
    for (Vec3& p : state.cloths[1].positions) p.y += frame == 199 ? 1 : 0;
    counter.Offer(state);
  }
  CHECK(WaitFor(counter, 199).count == 0);

  // What has blown up cannot be judged, and other cloths have no count before theirs.
  state.report.frame = 200;
  state.cloths[0].positions[0].x = std::numeric_limits<double>::quiet_NaN();
  counter.Offer(state);
  CHECK(counter.result()->frame == 199);
  counter.Offer(TwoTriangles(-0.5, 0));
  CHECK(WaitFor(counter, 0).count == 2);
  CHECK(woken > 2);
}
