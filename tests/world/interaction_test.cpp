// What a hand does to a running World: pins, handles, balls, gusts; and states that are saved.

#include "percale/interaction.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mesh/cloth_model.h"
#include "percale/parameters.h"
#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

Scene CurtainScene() {
  Scene scene = CourseScene("pinned2", 14);
  scene.spheres.push_back({{0.5, 0.6, 0.5}, 0.2, 0.3});
  scene.planes.push_back({{0, 0.2, 0}, {0, 1, 0.1}, 0.5});
  scene.pinMotions.push_back({0, {{13, 0}}, 0.1, 0.4, {-0.2, 0.1, 0}});
  scene.pinMotions.push_back({0, {}, 0, 0.6, {}, {0, 1, 0}, 30, {0.5, 1, 0}});
  scene.wind = {{1, 0, 2}, 0.5, 0.3, 0.8};
  return scene;
}

/// Nothing acts on it but what the test adds.
Scene FloatingScene() {
  Scene scene = CourseScene("pinned2", 12);
  scene.simulation.gravity = {};
  scene.simulation.selfCollision = false;
  scene.cloths[0].pinned.clear();
  scene.cloths[0].damping = 0;
  return scene;
}

/// A bit of everything that a hand can do.
void Disturb(World& world) {
  world.SetHandles({{0, 40, {0.3, 1.2, 0.4}, 0.15, 20}});
  world.AddBall({{0.5, 1.5, 0.5}, {0.1, -3, 0}, 0.1, 20});
  world.AddGust({{0, 8, 2}, 300, world.report().time + 0.05, 0.4});
}

Vec3 Momentum(const World& world) {
  const double mass = PointMass(world.scene().cloths[0]);
  Vec3 sum;
  for (const Vec3& v : world.Cloth(0).velocities()) sum += v * mass;
  for (const Ball& ball : world.balls()) sum += ball.velocity * ball.mass;
  return sum;
}

std::vector<std::uint64_t> Hashes(World& world, int frames) {
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < frames; ++i) {
    world.Step();
    hashes.push_back(world.StateHash());
  }
  return hashes;
}

}  // namespace

TEST_CASE("a World goes on from a saved state to the same bits") {
  for (const char* name : {"pinned2", "selfCollision", "sphere", "curtain"}) {
    CAPTURE(name);
    World world(name == std::string("curtain") ? CurtainScene() : CourseScene(name, 14));
    Run(world, 10);
    Disturb(world);
    Run(world, 10);
    WorldState state;
    world.Save(state);
    const std::uint64_t saved = world.StateHash();
    const std::vector<std::uint64_t> expected = Hashes(world, 25);

    world.Restore(state);
    CHECK(world.StateHash() == saved);
    CHECK(world.report().frame == 20);
    CHECK(Hashes(world, 25) == expected);

    // Another World, with other settings and another past.
    Scene other = *state.scene;
    other.cloths[0].ks = 300;
    other.cloths[0].pinned = {{3, 3}};
    other.pinMotions.clear();
    World second(std::move(other), {.threads = 2});
    Run(second, 3);
    second.Restore(state);
    CHECK(second.StateHash() == saved);
    CHECK(second.scene().cloths[0].ks == state.scene->cloths[0].ks);
    CHECK(Hashes(second, 25) == expected);

    // One that had other cloths.
    World third(SmallScene(4, 5));
    third.Restore(state);
    CHECK(Hashes(third, 25) == expected);
  }
}

TEST_CASE("a state saved at the start, and one saved when a pin was just set, go on alike") {
  World world(CurtainScene());
  WorldState start;
  world.Save(start);
  const auto expected = Hashes(world, 12);
  Scene pinned = world.scene();
  pinned.cloths[0].pinned.push_back({7, 9});
  CHECK(world.Apply(pinned));
  WorldState state;
  world.Save(state);
  const auto after = Hashes(world, 12);
  world.Restore(state);
  CHECK(Hashes(world, 12) == after);
  world.Restore(start);
  CHECK(Hashes(world, 12) == expected);
}

TEST_CASE("a state outlives a divergence") {
  World world(CourseScene("pinned2", 10));
  Run(world, 5);
  WorldState state;
  world.Save(state);
  const auto expected = Hashes(world, 5);
  Scene wild = world.scene();
  wild.cloths[0].ks = 1e9;
  world.Apply(wild);
  Run(world, 50);
  REQUIRE(world.report().divergence);
  world.Restore(state);
  CHECK_FALSE(world.report().divergence);
  CHECK(Hashes(world, 5) == expected);
}

TEST_CASE("a point that is pinned while the cloth moves stays where it is, and falls when it is let go") {
  World world(CourseScene("pinned2", 16));
  Run(world, 30);
  const int vertex = 10 * 16 + 5;
  const Vec3 held = world.Cloth(0).positions()[vertex];
  Scene scene = world.scene();
  scene.cloths[0].pinned.push_back({5, 10});
  CHECK(world.Apply(scene));
  CHECK(world.report().frame == 30);
  CHECK(world.Cloth(0).pinned().size() == 3);
  for (int frame = 0; frame < 40; ++frame) {
    world.Step();
    CHECK(world.Cloth(0).positions()[vertex] == held);
  }
  CHECK(world.Cloth(0).velocities()[vertex] == Vec3{});
  scene.cloths[0].pinned.pop_back();
  CHECK(world.Apply(scene));
  Run(world, 20);
  CHECK(world.Cloth(0).positions()[vertex].y < held.y - 0.01);
  // The start knows nothing of where the pin was set.
  scene.cloths[0].pinned.push_back({5, 10});
  world.Apply(scene);
  world.Reset();
  CHECK(world.Cloth(0).positions()[vertex].y == 1);
  Run(world, 5);
  CHECK(world.Cloth(0).positions()[vertex].y == 1);
}

TEST_CASE("a pin set during a motion of all pins is carried on from where it is") {
  Scene scene = CourseScene("pinned2", 12);
  scene.pinMotions.push_back({0, {}, 0, 1, {0, 0.5, 0}});
  World world(scene);
  Run(world, 45);  // half of the way
  const int vertex = 6 * 12 + 6;
  const Vec3 at = world.Cloth(0).positions()[vertex];
  scene.cloths[0].pinned.push_back({6, 6});
  REQUIRE(world.Apply(scene));
  world.Step();
  CHECK(Length(world.Cloth(0).positions()[vertex] - at) < 0.02);
  Run(world, 60);
  const Vec3 end = at + Vec3{0, 0.25, 0};
  CHECK(Length(world.Cloth(0).positions()[vertex] - end) < 1e-9);
}

TEST_CASE("a handle carries the cloth to its target at any mass and time step") {
  for (const double density : {1.0, 150.0, 20000.0}) {
    for (const int stepsPerFrame : {8, 30}) {
      CAPTURE(density);
      CAPTURE(stepsPerFrame);
      Scene scene = CourseScene("pinned2", 20);
      scene.cloths[0].ks = 30;
      scene.cloths[0].density = density;
      scene.cloths[0].pinned.clear();
      scene.simulation.stepsPerFrame = stepsPerFrame;
      World world(scene);
      const Vec3 target = {0.4, 1.3, 0.2};
      world.SetHandles({{0, 10 * 20 + 10, target, 0.12, 50}});
      Run(world, 180);
      REQUIRE_FALSE(world.report().divergence);
      CHECK(Length(world.Cloth(0).positions()[10 * 20 + 10] - target) < 0.05);
      world.SetHandles({});
      Run(world, 90);
      CHECK(world.Cloth(0).positions()[10 * 20 + 10].y < 0);
    }
  }
}

TEST_CASE("a handle leaves pins, and points outside its radius, to themselves") {
  Scene scene = FloatingScene();
  scene.cloths[0].ks = 0;
  scene.cloths[0].pinned = {{6, 6}, {2, 2}};
  World world(scene);
  world.SetHandles({{0, 6 * 12 + 5, {0.45, 1.002, 0.55}, 0.2, 50}});
  Run(world, 5);
  CHECK(world.Cloth(0).velocities()[6 * 12 + 6] == Vec3{});
  CHECK(world.Cloth(0).positions()[11 * 12 + 11].y == 1);
  CHECK(world.Cloth(0).positions()[6 * 12 + 4].y > 1);
}

TEST_CASE("a handle on a pin carries it, and it stays where it was carried until the cloth is reset") {
  World world(CourseScene("pinned2", 12));
  Run(world, 5);
  const Vec3 target = {0.3, 1.4, 0.2};
  world.SetHandles({{0, 0, target, 0.2, 50}});
  Run(world, 30);
  world.SetHandles({});
  const Vec3 held = world.Cloth(0).positions()[0];
  CHECK(Length(held - target) < 1e-3);
  Run(world, 10);
  CHECK(world.Cloth(0).positions()[0] == held);
  CHECK(world.Cloth(0).velocities()[0] == Vec3{});
  WorldState state;
  world.Save(state);
  const auto expected = Hashes(world, 5);
  world.Restore(state);
  CHECK(Hashes(world, 5) == expected);
  world.Reset();
  CHECK(world.Cloth(0).positions()[0] == Vec3{0, 1, 0});
}

TEST_CASE("cloth that is placed is there at once, keeps its velocity, and goes on from there") {
  World world(CourseScene("pinned2", 16));
  Run(world, 20);
  const int vertex = 12 * 16 + 7;
  const Vec3 target = world.Cloth(0).positions()[vertex] + Vec3{0.1, 0.2, -0.1};
  const Vec3 velocity = world.Cloth(0).velocities()[vertex];
  const Vec3 far = world.Cloth(0).positions()[3 * 16 + 3];
  world.Place({0, vertex, target, 0.2, 50});
  CHECK(Length(world.Cloth(0).positions()[vertex] - target) < 1e-12);
  CHECK(Length(world.Cloth(0).velocities()[vertex] - velocity) < 1e-9);
  CHECK(world.Cloth(0).positions()[3 * 16 + 3] == far);
  CHECK(world.report().frame == 20);
  WorldState state;
  world.Save(state);
  const auto expected = Hashes(world, 8);
  world.Restore(state);
  CHECK(Hashes(world, 8) == expected);
  // A pin is placed alone.
  const Vec3 beside = world.Cloth(0).positions()[1];
  world.Place({0, 0, {-0.2, 1.1, 0}, 0.5, 50});
  CHECK(Length(world.Cloth(0).positions()[0] - Vec3{-0.2, 1.1, 0}) < 1e-12);
  CHECK(world.Cloth(0).positions()[1] == beside);
}

TEST_CASE("cloth and ball exchange momentum without loss") {
  for (const double mass : {0.1, 5.0, 500.0}) {
    CAPTURE(mass);
    World world(FloatingScene());
    world.AddBall({{0.45, 1.4, 0.55}, {0.2, -4, 0}, 0.12, mass});
    const Vec3 before = Momentum(world);
    double slowest = 4;
    for (int frame = 0; frame < 40; ++frame) {
      world.Step();
      slowest = std::min(slowest, std::abs(world.balls()[0].velocity.y));
      CHECK(Length(Momentum(world) - before) < 1e-9 * Length(before));
    }
    CHECK(slowest < 3.99);
    CHECK(world.report().colliderContacts >= 0);
    // It is not inside: points may have been pushed back in by springs, by a part of a spacing.
    for (const Vec3& p : world.Cloth(0).positions()) CHECK(Length(p - world.balls()[0].position) > 0.5 * 0.12);
  }
}

TEST_CASE("a ball rebounds from a plane by the square of the restitution, and slows down by friction") {
  Scene scene = SmallScene(2, 2);
  scene.cloths[0].origin = {10, 10, 10};
  scene.planes.push_back({{0, 0, 0}, {0, -2, 0}, 0.25});
  World world(scene);
  world.AddBall({{0, 1.1, 0}, {0.3, 0, 0}, 0.1, 1});
  double highest = 0;
  bool fell = false;
  while (world.report().time < 1.2) {
    world.Step();
    const Ball& ball = world.balls()[0];
    CHECK(ball.position.y > 0.1 - 1e-9);
    fell = fell || ball.velocity.y > 0;
    if (fell) highest = std::max(highest, ball.position.y);
  }
  CHECK(highest - 0.1 == doctest::Approx(0.25).epsilon(0.02));
  CHECK(world.balls()[0].velocity.x == 0);  // friction 0.25 of an impulse of 1.5 * 4.4 m/s takes all 0.3 m/s
}

TEST_CASE("a ball bounces off a sphere, flies away, and is dropped") {
  Scene scene = SmallScene(2, 2);
  scene.cloths[0].origin = {10, 10, 10};
  scene.simulation.gravity = {};
  scene.spheres.push_back({{0, 0, 0}, 0.5, 0});
  World world(scene);
  world.AddBall({{2, 0, 0}, {-50, 0, 0}, 0.1, 1});
  Run(world, 9);
  CHECK(world.balls()[0].velocity.x == doctest::Approx(25));
  CHECK(world.balls()[0].position.x > 0.6);
  Run(world, 400);
  CHECK(world.balls().empty());
  for (std::size_t i = 0; i < kMostBalls + 3; ++i) world.AddBall({{double(i), 5, 0}, {}, 0.1, 1});
  CHECK(world.balls().size() == kMostBalls);
  CHECK(world.balls()[0].position.x == 3);
  world.Reset();
  CHECK(world.balls().empty());
}

TEST_CASE("a ball bounces off a box that comes towards it by as much more") {
  Scene scene = SmallScene(2, 2);
  scene.simulation.engine = Engine::Fabric;
  scene.cloths[0].origin = {10, 10, 10};
  scene.simulation.gravity = {};
  scene.colliders.resize(1);
  scene.colliders[0].shape = ColliderShape::Box;
  scene.colliders[0].size = {1, 2, 2};
  scene.colliders[0].friction = 0;
  for (const double speed : {0.0, 3.0}) {
    scene.colliderMotions.resize(1);
    scene.colliderMotions[0].displacement = {10 * speed, 0, 0};
    scene.colliderMotions[0].end = 10;
    scene.colliderMotions[0].steady = true;
    World world(scene);
    world.AddBall({{2, 0.1, 0}, {-8, 0, 0}, 0.1, 1});
    Run(world, 20);
    CHECK(world.balls()[0].velocity.x == doctest::Approx(speed + 0.5 * (8 + speed)));
    CHECK(world.balls()[0].velocity.y == doctest::Approx(0));
  }
}

TEST_CASE("a gust acts while it lasts, and by its drag") {
  Scene scene = FloatingScene();
  World calm(scene), windy(scene);
  windy.AddGust({{0, 5, 0}, 100, 0.2, 0.5});
  for (int frame = 0; frame < 18; ++frame) {  // until 0.2 s
    calm.Step();
    windy.Step();
  }
  CHECK(calm.StateHash() == windy.StateHash());
  Run(windy, 45);
  // One push of the mean over sin^2 ... of all points alike: m v' = d s^2 (5 s^2 - v) per area.
  const double density = scene.cloths[0].density;
  double v = 0;
  const double dt = 1e-5;
  for (double t = 0; t < 0.5; t += dt) {
    const double s = std::pow(std::sin(3.14159265358979 * t / 0.5), 2);
    v += dt * 100 / density * s * (5 * s - v);
  }
  const double pointMass = PointMass(scene.cloths[0]);
  const double perArea = scene.cloths[0].width * scene.cloths[0].height * density / (12 * 12 * pointMass);
  CHECK(perArea == doctest::Approx(1));
  const Vec3 velocity = windy.Cloth(0).velocities()[6 * 12 + 6];
  // A point stands for a spacing squared, which on 12 points is a little more than its share of the area.
  CHECK(velocity.y == doctest::Approx(v * std::pow(12.0 / 11.0, 2)).epsilon(0.1));
  WorldState state;
  Run(windy, 2);
  windy.Save(state);
  CHECK(state.gusts.empty());
}

TEST_CASE("numbers that will not do are told") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  CHECK_FALSE(Check(Handle{}));
  CHECK_FALSE(Check(Ball{}));
  CHECK_FALSE(Check(Gust{}));
  CHECK(Check(Handle{.target = {nan, 0, 0}}));
  CHECK(*Check(Handle{.radius = -1}) == "radius: expected a number > 0 m, got -1");
  CHECK(Check(Handle{.frequency = infinite}));
  CHECK(Check(Ball{.position = {0, infinite, 0}}));
  CHECK(Check(Ball{.velocity = {0, 0, 1e30}}));
  CHECK(Check(Ball{.radius = 0}));
  CHECK(Check(Ball{.mass = nan}));
  CHECK(Check(Gust{.drag = 0}));
  CHECK(Check(Gust{.start = nan}));
  CHECK(Check(Gust{.duration = -2}));
}
