// Cloth on colliders whose vertices move by a cache.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "collide/intersections.h"
#include "percale/checkpoint_file.h"
#include "percale/fabrics.h"
#include "percale/mesh_file.h"
#include "percale/scene_file.h"
#include "percale/world.h"
#include "physics/body.h"
#include "tests/sanitized.h"

using namespace percale;

namespace {

/// A silk sheet that lies over a tube which lies along x at y = 0.8, and hangs down on both sides.
Scene OverBody(const std::function<Vec3(const Vec3&, double time)>& motion, double seconds, double rate) {
  Scene scene = test::SheetScene(Fabric::Silk, 0.6, 0.8, 24, 32);
  scene.cloths[0].origin = {-0.3, -0.02, -0.4};
  scene.colliders.push_back(test::Body(motion, seconds, rate));
  scene.colliders[0].position = {0, 0.8, 0};
  return scene;
}

/// Breathes, bends, and goes to and fro.
Vec3 Pump(const Vec3& x, double time) {
  const double phase = 2 * std::numbers::pi * time;
  const double swell = 1 + 0.35 * std::sin(phase) * std::cos(3 * x.x);
  return {x.x, x.y * swell + 0.1 * std::sin(2 * x.x + phase), x.z * swell + 0.06 * std::sin(phase / 2)};
}

/// Of the cloth with itself, and with where the collider is.
std::int64_t CountAll(const World& world, WorldState& state, const Executor& executor) {
  world.Save(state);
  const ClothView cloth = world.Cloth(0);
  std::vector<Vec3> x(cloth.positions().begin(), cloth.positions().end());
  std::vector<Triangle> triangles(cloth.triangles().begin(), cloth.triangles().end());
  const auto first = static_cast<std::int32_t>(x.size());
  x.insert(x.end(), state.obstacles.begin() + std::ptrdiff_t(state.obstacles.size() / 2), state.obstacles.end());
  for (const Triangle& t : world.scene().colliders[0].loaded->mesh.triangles)
    triangles.push_back({t.a + first, t.b + first, t.c + first});
  return IntersectionJudge(static_cast<int>(x.size()), triangles, first).Count(x, executor).count;
}

double Farthest(const World& a, const World& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.Cloth(0).positions().size(); ++v)
    most = std::max(most, Length(a.Cloth(0).positions()[v] - b.Cloth(0).positions()[v]));
  return most;
}

}  // namespace

TEST_CASE("a cache that is a rigid motion does what the motion does") {
  // In binary fractions, which a cache holds to the bit.
  const Vec3 velocity{0.125, 0.25, -0.1875};
  const auto still = [](const Vec3& x, double) { return x; };
  Scene led = OverBody(still, 0.5, 32);
  led.colliderMotions.push_back({.end = 0.5, .displacement = velocity * 0.5, .steady = true});
  Scene cached = OverBody([&](const Vec3& x, double time) { return x + velocity * time; }, 0.5, 32);
  // The frame in which the cache moves may be another, and may move as well.
  SUBCASE("in the frame of the world") {}
  SUBCASE("in a frame that is turned") {
    cached.colliders[0].rotation = {0, 90, 0};
    led.colliders[0].rotation = {0, 90, 0};
    const Vec3 turned{velocity.z, velocity.y, -velocity.x};
    led.colliderMotions[0].displacement = turned * 0.5;
  }
  SUBCASE("with half of the motion by the scene") {
    cached = OverBody([&](const Vec3& x, double time) { return x + velocity * (time / 2); }, 0.5, 32);
    cached.colliderMotions.push_back({.end = 0.5, .displacement = velocity * 0.25, .steady = true});
  }
  World a(led, {.threads = 1}), b(cached, {.threads = 1});
  // Later the last bits decide how the sheet folds.
  for (int frame = 0; frame < 12; ++frame) {
    a.Step(), b.Step();
    CAPTURE(frame);
    CHECK(Farthest(a, b) < 1e-7);
  }
  CHECK(a.report().selfContacts > 100);
}

TEST_CASE("cloth on a body that pumps passes through nothing, at any number of threads") {
  const Executor executor(1);
  WorldState state;
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 3}) {
    World world(OverBody(Pump, 1, 15), {.threads = threads});
    std::int64_t contacts = 0;
    for (int frame = 0; frame < test::Fewer(60, 20); ++frame) {
      CAPTURE(frame);
      const StepReport& report = world.Step();
      REQUIRE(!report.divergence);
      CHECK(report.intersections == 0);
      contacts += report.selfContacts;
      if (threads == 1) CHECK(CountAll(world, state, executor) == 0);
    }
    CHECK(contacts > test::Fewer(10000));
    hashes.push_back(world.StateHash());
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("a state on a body that moves by a cache goes on to the same bits, also from a file") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "percale_cache_laws_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Scene scene = OverBody(Pump, 1, 15);
  test::WriteBody(scene.colliders[0], folder);
  REQUIRE(LoadMeshes(scene).ok());
  World world(scene, {.threads = 1});
  for (int frame = 0; frame < 20; ++frame) world.Step();
  WorldState state;
  world.Save(state);
  const auto goOn = [](World& from) { return test::HashAfter(from, 15); };
  const std::uint64_t hash = goOn(world);
  world.Restore(state);
  CHECK(goOn(world) == hash);
  const Result<WorldState> read = ParseCheckpoint(FormatCheckpoint(state), "memory");
  REQUIRE_MESSAGE(read.ok(), Format(read.diagnostics()));
  World other(*read->scene, {.threads = 1});
  other.Restore(*read);
  CHECK(goOn(other) == hash);
  // And the start is the start.
  World fresh(scene, {.threads = 1});
  other.Reset();
  CHECK(goOn(other) == goOn(fresh));
  std::filesystem::remove_all(folder);
}
