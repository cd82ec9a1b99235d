// Cloth that starts tangled comes apart, and stays so.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "math/splitmix64.h"
#include "mesh/rest_mesh.h"
#include "percale/fabrics.h"
#include "percale/intersections.h"
#include "percale/world.h"
#include "tests/sanitized.h"

using namespace percale;

namespace {

Scene FabricScene() {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = 60;
  scene.simulation.stepsPerFrame = 1;
  scene.planes.push_back({.point = {0, 0, 0}, .normal = {0, 1, 0}, .friction = 0.3});
  return scene;
}

/// Lies at y = 1 with its first corner at the origin.
ClothSettings Sheet(double side, int cells) {
  ClothSettings cloth;
  SetFabric(cloth, Fabric::Cotton);
  cloth.width = cloth.height = side;
  cloth.numWidthPoints = cloth.numHeightPoints = cells + 1;
  return cloth;
}

/// Stands in x, y above the origin.
ClothSettings Standing(double side, int cells, const Vec3& origin, const Vec3& rotation) {
  ClothSettings cloth = Sheet(side, cells);
  cloth.orientation = Orientation::Vertical;
  cloth.origin = origin;
  cloth.rotation = rotation;
  return cloth;
}

/// A small sheet through the middle of one that is held at its corners.
Scene ThroughScene() {
  Scene scene = FabricScene();
  scene.cloths = {Sheet(0.3, 15), Standing(0.2, 10, {0.053, 0.912, 0.147}, {})};
  scene.cloths[0].pinned = {{0, 0}, {15, 0}, {0, 15}, {15, 15}};
  return scene;
}

/// Two sheets that hang by their upper edges and cross, one `shift` aside.
Scene HangingScene(double degrees, double shift) {
  Scene scene = FabricScene();
  scene.cloths = {Standing(0.4, 16, {-0.2, 0.5, 0.001}, {degrees, 1, 0}),
                  Standing(0.4, 16, {-0.2 + shift, 0.51, 0}, {-degrees, 0, 0.5 * degrees})};
  for (ClothSettings& cloth : scene.cloths) {
    for (int i = 0; i <= 16; ++i) cloth.pinned.push_back({i, 16});
  }
  return scene;
}

/// Sheets all through each other.
Scene HeapScene(std::uint64_t seed) {
  SplitMix64 random(seed);
  const auto between = [&](double a, double b) { return a + (b - a) * random.NextUnit(); };
  Scene scene = FabricScene();
  for (int c = 0; c < 3; ++c) {
    const Vec3 origin = {between(-0.25, -0.1), between(0.1, 0.2), between(-0.1, 0.1)};
    const Vec3 rotation = {between(-90, 90), between(-90, 90), between(-90, 90)};
    scene.cloths.push_back(Standing(0.3, 12, origin, rotation));
  }
  return scene;
}

/// A strip that runs through itself in a loop.
Scene LoopScene() {
  constexpr int kLong = 41, kWide = 7;
  const auto path = [](double s) {
    const double t = (s - 0.5) * 3.2;
    return Vec3{0.18 * (t * t * t - 1.2 * t), 0.3 + 0.16 * t * t, 0};
  };
  RestMesh mesh;
  for (int j = 0; j < kWide; ++j) {
    double length = 0;
    for (int i = 0; i < kLong; ++i) {
      const Vec3 x = path(double(i) / (kLong - 1)), before = path(double(std::max(i - 1, 0)) / (kLong - 1));
      length += Length(x - before);
      mesh.positions.push_back(x + Vec3{0, 0, 0.02 * j});
      mesh.uv.push_back({length, 0.02 * j});
    }
  }
  for (int j = 0; j + 1 < kWide; ++j) {
    for (int i = 0; i + 1 < kLong; ++i) {
      const std::int32_t a = j * kLong + i, b = a + 1, c = a + kLong, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  std::vector<Vec2> cornerUv;
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : {t.a, t.b, t.c}) cornerUv.push_back(mesh.uv[std::size_t(v)]);
  }
  mesh.material = MaterialFromUv(cornerUv, 1);
  Scene scene = FabricScene();
  ClothSettings& cloth = scene.cloths.emplace_back();
  SetFabric(cloth, Fabric::Cotton);
  cloth.shape = Shape::Mesh;
  cloth.mesh = "loop.obj";
  cloth.loaded = std::make_shared<const LoadedMesh>(LoadedMesh{cloth.mesh, {}, mesh, 0});
  return scene;
}

/// Runs until all is apart, and then half a second on.
void ComesApart(const Scene& scene, int frames) {
  World world(scene, {.threads = 1});
  ClothJudge judge(world, 1);
  const std::int64_t first = judge.Count(world).count;
  CHECK(first > 10);
  int frame = 0;
  std::int64_t left = first;
  for (; frame < frames && left > 0; ++frame) {
    const StepReport& report = world.Step();
    REQUIRE(!report.divergence);
    left = judge.Count(world).count;
    CHECK(report.intersections == left);
    CHECK(report.greatestStretch < 2);
  }
  CAPTURE(frame);
  CHECK(left == 0);
  for (int k = 0; k < 30 && left == 0; ++k) {
    CHECK(world.Step().intersections == 0);
    CHECK(judge.Count(world).count == 0);
  }
}

}  // namespace

TEST_CASE("a sheet through the middle of another is out within a second, and stays so") {
  ComesApart(ThroughScene(), 60);
}

TEST_CASE("sheets that hang and cross are apart within a second, however small the angle") {
  for (const double degrees : {1.0, 4.0, 10.0}) {
    for (const double shift : {0.0, 0.05}) {
      CAPTURE(degrees);
      CAPTURE(shift);
      ComesApart(HangingScene(degrees, shift), 60);
    }
  }
}

TEST_CASE("a strip that runs through itself comes apart") {
  ComesApart(LoopScene(), 120);
}

TEST_CASE("sheets all through each other come apart") {
  for (int seed = 1; seed <= test::Fewer(4); ++seed) {
    CAPTURE(seed);
    ComesApart(HeapScene(std::uint64_t(seed)), 180);
  }
}

TEST_CASE("thin cloth that is pierced far from all edges and vertices is seen at the start") {
  Scene scene = FabricScene();
  scene.simulation.gravity = {};
  scene.cloths = {Sheet(1, 20), Standing(0.5, 10, {0.235, 0.77, 0.452}, {7, 11, 13})};
  for (ClothSettings& cloth : scene.cloths) cloth.contactDistance = 0.0001;
  World world(scene, {.threads = 1});
  const std::int64_t start = ClothJudge(world, 1).Count(world).count;
  CHECK(start > 0);
  world.Step();
  CHECK(world.report().intersections > 0);
}

TEST_CASE("what is tangled comes apart to the same bits for any number of threads, and from a state in between") {
  std::vector<std::uint64_t> hashes;
  WorldState middle;
  for (const int threads : {1, 3}) {
    World world(HeapScene(5), {.threads = threads});
    for (int frame = 0; frame < 20; ++frame) {
      if (frame == 10) world.Save(middle);
      world.Step();
    }
    hashes.push_back(world.StateHash());
  }
  CHECK(hashes[0] == hashes[1]);
  World world(HeapScene(5), {.threads = 2});
  world.Restore(middle);
  for (int frame = 10; frame < 20; ++frame) world.Step();
  CHECK(world.StateHash() == hashes[0]);
}
