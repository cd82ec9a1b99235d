#include "collide/poses.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "math/splitmix64.h"
#include "mesh/rest_mesh.h"

using namespace percale;

namespace {

Scene OneCollider() {
  Scene scene;
  scene.colliders.resize(1);
  scene.colliders[0].shape = ColliderShape::Box;
  scene.colliders[0].position = {1, 2, 3};
  scene.colliders[0].rotation = {20, -40, 75};
  return scene;
}

double Difference(const Pose& a, const Pose& b) {
  double greatest = Length(a.position - b.position);
  for (int k = 0; k < 9; ++k) greatest = std::max(greatest, std::abs(a.rotation.m[k] - b.rotation.m[k]));
  return greatest;
}

/// By how far it is from turning without stretching or mirroring.
double Distortion(const Matrix3<double>& r) {
  const Matrix3<double> square = Product(Transposed(r), r);
  double greatest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) greatest = std::max(greatest, std::abs(square(i, j) - (i == j)));
  }
  const Vec3 x = Times(r, {1, 0, 0}), y = Times(r, {0, 1, 0}), z = Times(r, {0, 0, 1});
  return std::max(greatest, std::abs(Dot(Cross(x, y), z) - 1));
}

}  // namespace

TEST_CASE("a collider is turned as cloth is") {
  ClothSettings cloth;
  cloth.shape = Shape::Disc;
  cloth.rings = 3;
  cloth.rotation = {20, -40, 75};
  const std::vector<Vec3> turned = MakeClothMesh(cloth).positions;
  cloth.rotation = {};
  const std::vector<Vec3> plain = MakeClothMesh(cloth).positions;
  const Pose pose = PoseOf(OneCollider(), 0, 0);
  // Vertex 0 is the middle of the disc and of its box.
  for (std::size_t v = 0; v < plain.size(); ++v)
    CHECK(Length(Times(pose.rotation, plain[v] - plain[0]) - (turned[v] - turned[0])) < 1e-14);
}

TEST_CASE("to the world and back") {
  const Pose pose = PoseOf(OneCollider(), 0, 0);
  CHECK(Distortion(pose.rotation) < 1e-15);
  CHECK(ToWorld(pose, {}) == Vec3{1, 2, 3});
  const Vec3 p{0.3, -0.7, 0.2};
  CHECK(Length(ToLocal(pose, ToWorld(pose, p)) - p) < 1e-15);
}

TEST_CASE("quarter turns are exact, and the thousandth turn is as good as the first") {
  for (int quarters = -9; quarters <= 9; ++quarters) {
    const SinCos sc = SinCosOf(90.0 * quarters);
    CHECK(std::abs(sc.sin) + std::abs(sc.cos) == 1);
    CHECK(sc.sin == doctest::Approx(std::sin(quarters * std::numbers::pi / 2)));
    CHECK(sc.cos == doctest::Approx(std::cos(quarters * std::numbers::pi / 2)));
  }
  for (const double degrees : {-200.0, -45.0, 0.5, 33.0, 45.0, 90.5, 179.0, 300.0}) {
    const SinCos sc = SinCosOf(degrees), later = SinCosOf(degrees + 360 * 1024);
    CHECK(sc.sin == doctest::Approx(std::sin(degrees * std::numbers::pi / 180)).epsilon(1e-15));
    CHECK(sc.cos == doctest::Approx(std::cos(degrees * std::numbers::pi / 180)).epsilon(1e-15));
    CHECK(later.sin == sc.sin);
    CHECK(later.cos == sc.cos);
  }
}

TEST_CASE("motions begin and end at rest unless they are steady") {
  Scene scene = OneCollider();
  ColliderMotion motion;
  motion.start = 1;
  motion.end = 3;
  motion.displacement = {0, 4, 0};
  motion.angle = 180;
  scene.colliderMotions = {motion};
  const Pose before = PoseOf(scene, 0, 0), at = PoseOf(scene, 0, 1), half = PoseOf(scene, 0, 2),
             after = PoseOf(scene, 0, 3), late = PoseOf(scene, 0, 1e6);
  CHECK(Difference(before, at) == 0);
  CHECK(Difference(after, late) == 0);
  CHECK(after.position == Vec3{1, 6, 3});
  CHECK(half.position == Vec3{1, 4, 3});
  constexpr double kMoment = 1e-4;
  CHECK(Difference(PoseOf(scene, 0, 1 + kMoment), at) < 10 * kMoment * kMoment);
  CHECK(Difference(PoseOf(scene, 0, 3 - kMoment), after) < 10 * kMoment * kMoment);

  scene.colliderMotions[0].steady = true;
  for (const double time : {1.0, 1.25, 1.5, 2.5, 3.0}) {
    const Pose pose = PoseOf(scene, 0, time);
    CHECK(pose.position.y == 2 + 2 * (time - 1));
    const Matrix3<double> turn = Product(pose.rotation, Transposed(at.rotation));
    const double angle = (time - 1) * std::numbers::pi / 2;
    CHECK(Length(Times(turn, {1, 0, 0}) - Vec3{std::cos(angle), 0, -std::sin(angle)}) < 1e-15);
  }
}

TEST_CASE("displacements add up in any order, and turns follow one another") {
  Scene scene = OneCollider();
  SplitMix64 random(5);
  for (int k = 0; k < 4; ++k) {
    ColliderMotion& motion = scene.colliderMotions.emplace_back();
    motion.start = 0.2 * k;
    motion.end = 1 + 0.3 * k;
    motion.displacement = {random.NextUnit(), random.NextUnit(), random.NextUnit()};
  }
  Scene other = scene;
  std::swap(other.colliderMotions[0], other.colliderMotions[3]);
  for (const double time : {0.1, 0.5, 1.7, 3.0})
    CHECK(Difference(PoseOf(scene, 0, time), PoseOf(other, 0, time)) < 1e-15);

  // A quarter turn about x, then one about y: the collider's y goes to z, and from there to x.
  scene = OneCollider();
  scene.colliders[0].rotation = {};
  scene.colliderMotions.resize(2);
  scene.colliderMotions[0].axis = {3, 0, 0};
  scene.colliderMotions[0].angle = 90;
  scene.colliderMotions[1].axis = {0, 0.1, 0};
  scene.colliderMotions[1].angle = 90;
  CHECK(Times(PoseOf(scene, 0, 1).rotation, {0, 1, 0}) == Vec3{1, 0, 0});
}

TEST_CASE("many turns about the collider's own position leave it there") {
  Scene scene = OneCollider();
  ColliderMotion& motion = scene.colliderMotions.emplace_back();
  motion.end = 10;
  motion.axis = {1, 2, -0.5};
  motion.angle = 360 * 50;
  motion.steady = true;
  const Pose start = PoseOf(scene, 0, 0);
  CHECK(Difference(PoseOf(scene, 0, 10), start) == 0);
  for (const double time : {0.03, 2.71, 9.99}) {
    const Pose pose = PoseOf(scene, 0, time);
    CHECK(pose.position == start.position);
    CHECK(Distortion(pose.rotation) < 1e-14);
    CHECK(Difference(pose, start) > 0.1);
    const Vec3 axis = UnitOr(motion.axis, {});
    const Vec3 turned = Times(Product(pose.rotation, Transposed(start.rotation)), axis);
    CHECK(Length(turned - axis) < 1e-14);
  }
}

TEST_CASE("about a centre of its own choice the collider keeps its distance, and displacements carry the centre") {
  Scene scene = OneCollider();
  ColliderMotion turn;
  turn.axis = {0, 1, 0};
  turn.angle = 90;
  turn.ownCentre = false;
  turn.centre = {1, 0, 2};
  scene.colliderMotions = {turn};
  CHECK(Length(PoseOf(scene, 0, 1).position - Vec3{2, 2, 2}) < 1e-15);
  ColliderMotion way;
  way.displacement = {10, 0, 0};
  scene.colliderMotions = {way, turn};
  CHECK(Length(PoseOf(scene, 0, 1).position - Vec3{12, 2, 2}) < 1e-14);
  // Motions of another collider are none of its business.
  scene.colliders.resize(2);
  CHECK(PoseOf(scene, 1, 1).position == Vec3{});
}

TEST_CASE("the solids of a scene, in their order and at their places") {
  Scene scene = OneCollider();
  scene.spheres = {{{0, 1, 0}, 0.5, 0.1}, {{0, 2, 0}, 0.25, 0.2}};
  scene.planes = {{{0, -1, 0}, {0, 2, 0}, 0.4}, {{3, 0, 0}, {-1, -1, 0}, 0.4}, {{0, 5, 0}, {0, -3, 0}, 0.4}};
  scene.planesFirst = true;
  scene.colliders.resize(3);
  scene.colliders[1].shape = ColliderShape::Mesh;
  scene.colliders[2].shape = ColliderShape::Torus;
  scene.colliders[2].thickness = 0.01;
  ColliderMotion& motion = scene.colliderMotions.emplace_back();
  motion.collider = 2;
  motion.displacement = {0, 0, 1};
  std::vector<PlacedSolid> solids;
  ListSolids(scene, 0.5, solids);
  REQUIRE(solids.size() == 7);
  const ColliderShape kinds[] = {ColliderShape::Sphere, ColliderShape::Sphere, ColliderShape::Plane,
                                 ColliderShape::Plane,  ColliderShape::Plane,  ColliderShape::Box,
                                 ColliderShape::Torus};
  const int colliders[] = {-1, -1, -1, -1, -1, 0, 2};
  for (std::size_t k = 0; k < solids.size(); ++k) {
    CHECK(solids[k].solid.kind == kinds[k]);
    CHECK(solids[k].collider == colliders[k]);
    CHECK(Distortion(solids[k].pose.rotation) < 1e-15);
  }
  CHECK(solids[1].friction == 0.2);
  CHECK(solids[6].thickness == 0.01);
  CHECK(solids[6].pose.position == Vec3{0, 0, 0.5});
  CHECK(DistanceTo(solids[1], {0, 2, 1}).distance == 0.75);
  CHECK(DistanceTo(solids[2], {7, 1, 7}).distance == 2);
  CHECK(DistanceTo(solids[3], {0, 0, 4}).distance == doctest::Approx(3 / std::numbers::sqrt2));
  CHECK(Length(DistanceTo(solids[3], {0, 0, 4}).normal - UnitOr({-1, -1, 0}, {})) < 1e-15);
  CHECK(DistanceTo(solids[4], {0, 4, 0}).distance == 1);

  std::vector<PlacedSolid> moved = solids;
  MoveSolids(scene, 0.8, moved);
  ListSolids(scene, 0.8, solids);
  for (std::size_t k = 0; k < solids.size(); ++k)
    CHECK(std::memcmp(&solids[k].pose, &moved[k].pose, sizeof(Pose)) == 0);
}

TEST_CASE("a jump is all there at its end, and not a bit before") {
  Scene scene;
  scene.colliders.resize(2);
  ColliderMotion& motion = scene.colliderMotions.emplace_back();
  motion.collider = 1;
  motion.end = 2;
  motion.displacement = {1, 2, 3};
  motion.jump = true;
  for (const double time : {0.0, 1.0, std::nextafter(2.0, 0.0)}) CHECK(PoseOf(scene, 1, time).position == Vec3{});
  for (const double time : {2.0, 7.0}) CHECK(PoseOf(scene, 1, time).position == Vec3{1, 2, 3});
  CHECK(Jumps(scene, 1, 1.9, 2));
  CHECK(Jumps(scene, 1, 0, 9));
  CHECK_FALSE(Jumps(scene, 1, 2, 2.1));
  CHECK_FALSE(Jumps(scene, 1, 1.8, 1.9));
  CHECK_FALSE(Jumps(scene, 0, 1.9, 2));
  motion.jump = false;
  CHECK_FALSE(Jumps(scene, 1, 1.9, 2));
}

TEST_CASE("a plane's frame is turned as little as can be, for normals all around") {
  SplitMix64 random(3);
  for (int k = 0; k < 200; ++k) {
    const double x = random.NextUnit(), y = random.NextUnit(), z = random.NextUnit();
    const Vec3 normal = UnitOr(k < 2 ? Vec3{0, k == 0 ? 1.0 : -1.0, 0} : Vec3{x - 0.5, y - 0.5, z - 0.5}, {});
    const Matrix3<double> turn = RotationFromY(normal);
    CHECK(Distortion(turn) < 1e-14);
    CHECK(Length(Times(turn, {0, 1, 0}) - normal) < 1e-15);
  }
}
