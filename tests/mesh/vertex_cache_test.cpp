#include "mesh/vertex_cache.h"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

using namespace percale;

namespace {

/// A triangle whose first vertex goes along x by 1, then 3 units, and whose last rises by 2 in the second stretch.
Scene Triangles(double spacing) {
  Scene scene;
  scene.simulation.framesPerSecond = 60;
  ColliderSettings& collider = scene.colliders.emplace_back();
  collider.shape = ColliderShape::Mesh;
  collider.mesh = "a.obj", collider.cache = "a.pc2";
  collider.meshScale = 0.5;
  LoadedMesh mesh;
  mesh.mesh.positions = {{5, 5, 5}, {1, 0, 0}, {0, 1, 0}};
  mesh.mesh.triangles = {{0, 1, 2}};
  collider.loaded = std::make_shared<const LoadedMesh>(mesh);
  VertexCache cache{"a.pc2", spacing, 3, 0, {}};
  for (const float x : {0.0f, 1.0f, 4.0f})
    cache.positions.insert(cache.positions.end(), {x, 0, 0, 1, 0, 0, 0, 1, x > 1 ? 2.0f : 0.0f});
  collider.loadedCache = std::make_shared<const VertexCache>(cache);
  return scene;
}

std::vector<Vec3> At(const Scene& scene, double time) {
  std::vector<Vec3> positions(3);
  PlaceVertices(scene, scene.colliders[0], time, positions);
  return positions;
}

}  // namespace

TEST_CASE("vertices go from sample to sample on straight lines, and rest before the first and after the last") {
  Scene scene = Triangles(0.125);
  CHECK(SampleSeconds(scene, scene.colliders[0]) == 0.125);
  for (const double time : {-1.0, 0.0})
    CHECK(At(scene, time) == std::vector<Vec3>{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}});
  CHECK(At(scene, 0.0625)[0] == Vec3{0.25, 0, 0});
  CHECK(At(scene, 0.125)[0] == Vec3{0.5, 0, 0});
  CHECK(At(scene, 0.1875) == std::vector<Vec3>{{1.25, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0.5}});
  for (const double time : {0.25, 9.0, 1e6})
    CHECK(At(scene, time) == std::vector<Vec3>{{2, 0, 0}, {0.5, 0, 0}, {0, 0.5, 1}});
  scene.colliders[0].cacheStart = 2;
  CHECK(At(scene, 2)[0] == Vec3{});
  CHECK(At(scene, 2.0625)[0] == Vec3{0.25, 0, 0});
}

TEST_CASE("a cache's rate is the scene's, or else its file's, in seconds or in frames") {
  Scene scene = Triangles(1);
  CHECK(SampleSeconds(scene, scene.colliders[0]) == 1.0 / 60);
  scene.simulation.framesPerSecond = 24;
  CHECK(SampleSeconds(scene, scene.colliders[0]) == 1.0 / 24);
  scene.colliders[0].cacheRate = 4;
  CHECK(SampleSeconds(scene, scene.colliders[0]) == 0.25);
  CHECK(At(scene, 0.125)[0] == Vec3{0.25, 0, 0});
}

TEST_CASE("a file that states seconds is taken by its word, however slow") {
  Scene scene = Triangles(2);
  VertexCache slow = *scene.colliders[0].loadedCache;
  slow.inSeconds = true;
  scene.colliders[0].loadedCache = std::make_shared<const VertexCache>(slow);
  CHECK(SampleSeconds(scene, scene.colliders[0]) == 2);
  CHECK(At(scene, 1)[0] == Vec3{0.25, 0, 0});
}

TEST_CASE("without a cache, or with one sample, the vertices rest") {
  Scene scene = Triangles(0);
  VertexCache one = *scene.colliders[0].loadedCache;
  one.samples = 1;
  one.positions.resize(9);
  scene.colliders[0].loadedCache = std::make_shared<const VertexCache>(one);
  for (const double time : {-1.0, 0.0, 5.0}) CHECK(At(scene, time)[0] == Vec3{});
  CHECK_FALSE(LacksCache(scene.colliders[0]));
  scene.colliders[0].loadedCache.reset();
  CHECK(LacksCache(scene.colliders[0]));
  CHECK(At(scene, 0)[0] == Vec3{5, 5, 5});
}
