// Solids smaller than the cells of a cloth, between whose vertices they would fit.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "collide/poses.h"
#include "tests/physics/body.h"

using namespace percale;
using namespace percale::test;

namespace {

constexpr double kRadius = 0.012;  // a quarter of a cell [m]
constexpr double kWay = 0.3;       // [m]
constexpr double kSeconds = 0.2;

ColliderSettings Thin(ColliderShape shape) {
  ColliderSettings solid;
  solid.shape = shape;
  solid.position = {0.213, 0.218, 0.1};  // in the middle of a triangle of the sheet
  solid.radius = kRadius;
  solid.length = 0.12;
  if (shape == ColliderShape::Torus) solid.radius = 0.06, solid.tubeRadius = kRadius;
  if (shape == ColliderShape::Box) solid.size = {2 * kRadius, 0.12, 2 * kRadius};
  return solid;
}

/// A sheet of cells of 0.05 m that hangs by two corners, and the solid on its way through.
Scene ThinScene(const ColliderSettings& solid, double framesPerSecond) {
  Scene scene = SheetScene(Fabric::Cotton, 0.4, 0.4, 8, 8);
  scene.simulation.framesPerSecond = framesPerSecond;
  ClothSettings& sheet = scene.cloths[0];
  sheet.orientation = Orientation::Vertical;
  sheet.pinned = {{0, 8}, {8, 8}};
  sheet.contactDistance = 0.004;
  scene.colliders.push_back(solid);
  scene.colliderMotions.push_back({.start = 0, .end = kSeconds, .displacement = {0, 0, -kWay}, .steady = true});
  return scene;
}

/// How far points all over the cloth are from the solid, the least of it [m].
double LeastDistance(const World& world, const PlacedSolid& solid) {
  constexpr int kParts = 12;
  const std::span<const Vec3> x = world.Cloth(0).positions();
  double least = 1;
  for (const Triangle& t : world.Cloth(0).triangles()) {
    const auto at = [&](std::int32_t v) { return x[static_cast<std::size_t>(v)]; };
    for (int i = 0; i <= kParts; ++i) {
      for (int j = 0; i + j <= kParts; ++j) {
        const Vec3 p = at(t.a) + (at(t.b) - at(t.a)) * (1.0 * i / kParts) + (at(t.c) - at(t.a)) * (1.0 * j / kParts);
        least = std::min(least, DistanceTo(solid, p).distance);
      }
    }
  }
  return least;
}

double MeanZ(const World& world) {
  double sum = 0;
  for (const Vec3& x : world.Cloth(0).positions()) sum += x.z;
  return sum / static_cast<double>(world.Cloth(0).positions().size());
}

constexpr ColliderShape kShapes[] = {ColliderShape::Sphere,   ColliderShape::Box,  ColliderShape::Capsule,
                                     ColliderShape::Cylinder, ColliderShape::Cone, ColliderShape::Torus};

}  // namespace

TEST_CASE("what is thinner than the cells of cloth stays out of it between vertices, and carries it along") {
  for (const ColliderShape shape : kShapes) {
    for (const double turn : {0.0, 40.0, 90.0}) {
      CAPTURE(static_cast<int>(shape));
      CAPTURE(turn);
      ColliderSettings solid = Thin(shape);
      solid.rotation = {turn, 0, 0};
      // It goes half its radius in a frame, so none misses it inside.
      const Scene scene = ThinScene(solid, 240);
      World world(scene);
      double least = 1;
      for (int frame = 1; frame <= 240 * kSeconds; ++frame) {
        world.Step();
        std::vector<PlacedSolid> placed;
        ListSolids(scene, frame * scene.TimeStep(), placed);
        least = std::min(least, LeastDistance(world, placed[0]));
      }
      // The middle of a cone is a line, from which its sides are as far as its radius.
      CHECK(least > (shape == ColliderShape::Cone ? -0.1 * kRadius : 0));
      CHECK(MeanZ(world) < -0.1 * kWay);
    }
  }
}

TEST_CASE("however fast it goes") {
  for (const ColliderShape shape : kShapes) {
    CAPTURE(static_cast<int>(shape));
    Scene scene = ThinScene(Thin(shape), 60);
    scene.colliderMotions[0].end = 0.02;  // 15 m/s, 0.25 m in a frame
    World world(scene);
    for (int frame = 0; frame < 3; ++frame) world.Step();
    std::vector<PlacedSolid> placed;
    ListSolids(scene, 3 * scene.TimeStep(), placed);
    CHECK(LeastDistance(world, placed[0]) > (shape == ColliderShape::Cone ? -0.1 * kRadius : 0));
    CHECK(MeanZ(world) < -0.1 * kWay);
  }
}

TEST_CASE("a thin rod that spins draws the cloth that lies across it along") {
  double way[3];
  for (const int turns : {-1, 0, 1}) {
    Scene scene = SheetScene(Fabric::Cotton, 0.4, 0.1, 9, 2);  // no vertex lies on the rod
    scene.cloths[0].contactDistance = 0.004;
    ColliderSettings rod = Thin(ColliderShape::Capsule);
    rod.rotation = {90, 0, 0};
    rod.length = 0.3;
    rod.position = {0.2, World(scene).Cloth(0).positions()[0].y - kRadius - 0.004, 0.05};
    rod.friction = 0.5;
    scene.colliders.push_back(rod);
    scene.colliderMotions.push_back(
        {.end = kSeconds, .displacement = {}, .axis = {0, 0, 1}, .angle = 360.0 * turns, .steady = true});
    World world(scene);
    for (int frame = 0; frame < 60 * kSeconds; ++frame) world.Step();
    double sum = 0;
    for (const Vec3& x : world.Cloth(0).positions()) sum += x.x - 0.2;
    way[turns + 1] = sum / static_cast<double>(world.Cloth(0).positions().size());
  }
  // The surface goes 0.075 m; counter-clockwise about z its upper side goes towards -x.
  CHECK(way[0] > 0.01);
  CHECK(std::abs(way[1]) < 1e-6);
  CHECK(way[2] < -0.01);
}
