// Contact and friction of the fabric engine: what holds whatever the scene.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "percale/checkpoint_file.h"
#include "percale/fabrics.h"
#include "percale/intersections.h"
#include "percale/world.h"
#include "tests/sanitized.h"

using namespace percale;

namespace {

Scene FabricScene(int stepsPerSecond) {
  Scene scene;
  scene.simulation.engine = Engine::Fabric;
  scene.simulation.framesPerSecond = stepsPerSecond;
  scene.simulation.stepsPerFrame = 1;
  scene.wind.airDensity = 0;
  return scene;
}

/// Cotton that lies at y = 1.
ClothSettings Sheet(double width, double height, int columns, int rows) {
  ClothSettings cloth;
  SetFabric(cloth, Fabric::Cotton);
  cloth.width = width, cloth.height = height;
  cloth.numWidthPoints = columns + 1, cloth.numHeightPoints = rows + 1;
  return cloth;
}

/// Each step solved to rounding.
void SolveExactly(Scene& scene) {
  scene.simulation.newtonIterations = 60;
  scene.simulation.linearIterations = 200;
  scene.simulation.tolerance = 1e-9;
}

/// Gives all vertices of a cloth a velocity.
void Throw(World& world, int cloth, const Vec3& velocity) {
  WorldState state;
  world.Save(state);
  WorldState::Cloth& thrown = state.cloths[static_cast<std::size_t>(cloth)];
  for (std::size_t v = 0; v < thrown.positions.size(); ++v)
    thrown.previous[v] = thrown.positions[v] - velocity * world.scene().TimeStep();
  world.Restore(state);
}

/// Of each vertex: a third of each of its triangles [kg].
std::vector<double> Masses(const World& world, int c) {
  const ClothView cloth = world.Cloth(c);
  const ClothSettings& settings = world.scene().cloths[static_cast<std::size_t>(c)];
  const double third = settings.density * settings.width * settings.height / (3.0 * double(cloth.triangles().size()));
  std::vector<double> mass(cloth.positions().size());
  for (const Triangle& t : cloth.triangles()) {
    for (const std::int32_t v : {t.a, t.b, t.c}) mass[static_cast<std::size_t>(v)] += third;
  }
  return mass;
}

struct Momenta {
  Vec3 linear, angular;
};
/// Of velocities at the places where the cloths are now.
Momenta MomentaOf(const World& world, const std::vector<std::vector<Vec3>>& velocities) {
  Momenta sum;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const std::vector<double> mass = Masses(world, c);
    for (std::size_t v = 0; v < mass.size(); ++v) {
      const Vec3 momentum = velocities[static_cast<std::size_t>(c)][v] * mass[v];
      sum.linear += momentum;
      sum.angular += Cross(world.Cloth(c).positions()[v], momentum);
    }
  }
  return sum;
}
std::vector<std::vector<Vec3>> Velocities(const World& world) {
  std::vector<std::vector<Vec3>> all;
  for (int c = 0; c < world.ClothCount(); ++c) {
    const std::span<const Vec3> u = world.Cloth(c).velocities();
    all.emplace_back(u.begin(), u.end());
  }
  return all;
}

/// A sheet on a slope of tan α = 0.5.
World OnSlope(double friction) {
  Scene scene = FabricScene(60);
  SolveExactly(scene);
  ClothSettings sheet = Sheet(0.1, 0.1, 5, 5);
  sheet.contactDistance = 0.006;
  sheet.origin = {0, -1, 0};
  sheet.rotation = {0, 0, -std::atan(0.5) * 180 / 3.14159265358979323846};
  scene.cloths.push_back(sheet);
  const Vec3 normal = Vec3{1, 2, 0} / std::sqrt(5.0);
  // The sheet turns about its middle.
  scene.planes.push_back({.point = Vec3{0.05, 0, 0.05} - normal * 0.0058, .normal = normal, .friction = friction});
  return World(scene, {.threads = 1});
}

/// Half of a sheet is turned over onto the other half, which lies on a box that moves and turns; a ball falls in.
Scene FoldScene() {
  Scene scene = FabricScene(60);
  ClothSettings sheet = Sheet(0.4, 0.2, 24, 12);
  for (int j = 0; j <= 12; ++j) sheet.pinned.push_back({24, j});
  scene.cloths.push_back(sheet);
  scene.cloths.push_back(Sheet(0.15, 0.15, 8, 8));
  scene.cloths[1].origin = {0.05, 0.2, 0.02};
  PinMotion over;
  over.end = 0.7;
  over.axis = {0, 0, 1};
  over.angle = 170;
  over.centre = {0.2, 1.01, 0};
  scene.pinMotions.push_back(over);
  ColliderSettings table;
  table.shape = ColliderShape::Box;
  table.position = {0.2, 0.94, 0.1};
  table.size = {0.3, 0.1, 0.15};
  scene.colliders.push_back(table);
  scene.colliderMotions.push_back({.start = 0.1, .end = 1, .displacement = {0.02, 0.01, 0}, .angle = 20});
  scene.spheres.push_back({{0.1, 0.9, 0.3}, 0.1, 0.2});
  return scene;
}

constexpr int kFoldFrames = 40;
constexpr int kShotFrames = test::Fewer(20, 10);

/// A sheet that hangs by two corners, and a ball that flies through its middle at 30 m/s, or not, so far to the side;
/// another sheet falls far away.
Scene ShotScene(bool shot, double aside) {
  Scene scene = FabricScene(60);
  const int cells = test::Fewer(20, 10);
  ClothSettings hanging = Sheet(0.4, 0.4, cells, cells);
  hanging.orientation = Orientation::Vertical;
  hanging.pinned = {{0, cells}, {cells, cells}};
  scene.cloths.push_back(hanging);
  scene.cloths.push_back(Sheet(0.1, 0.1, 4, 4));
  scene.cloths[1].origin = {10, 0, 0};
  ColliderSettings ball;
  ball.position = {0.2 + aside, 0.2, 0.5};
  ball.radius = 0.06;
  scene.colliders.push_back(ball);
  scene.colliderMotions.push_back(
      {.start = 0.05, .end = 0.1, .displacement = {0, 0, shot ? -1.5 : 0.0}, .steady = true});
  return scene;
}

}  // namespace

TEST_CASE("cloth that meets cloth keeps the momentum of both, and hardly turns them") {
  for (const double friction : {0.0, 0.5}) {
    CAPTURE(friction);
    Scene scene = FabricScene(100);
    SolveExactly(scene);
    scene.simulation.gravity = {};
    scene.cloths.assign(2, Sheet(0.1, 0.1, 5, 5));
    scene.cloths[1].origin = {0.03, 0.02, 0.02};
    scene.cloths[1].rotation = {3, 0, 8};
    for (ClothSettings& cloth : scene.cloths) {
      cloth.friction = friction;
      cloth.stretchDamping = cloth.bendDamping = 0;
    }
    World world(scene, {.threads = 1});
    Throw(world, 1, {0.4, -1, 0.2});
    const Momenta start = MomentaOf(world, Velocities(world));
    std::int64_t contacts = 0;
    for (int k = 0; k < 20; ++k) {
      const std::vector<std::vector<Vec3>> before = Velocities(world);
      contacts += world.Step().selfContacts;
      const Momenta now = MomentaOf(world, Velocities(world));
      CHECK(Length(now.linear - start.linear) < 1e-6 * Length(start.linear));
      // What backward Euler loses aside. Planes are those of where a step begins, and so turn the sheets a little; so
      // does friction, whose two forces act at a distance.
      CHECK(Length(now.angular - MomentaOf(world, before).angular) < 5e-3 * Length(start.angular));
    }
    CHECK(contacts > 100);
  }
}

TEST_CASE("friction holds a sheet on a slope below its angle, and lets it go beyond") {
  for (const double friction : {0.45, 0.55}) {
    CAPTURE(friction);
    World world = OnSlope(friction);
    for (int k = 0; k < 30; ++k) world.Step();
    const Vec3 before = world.Cloth(0).positions()[0], velocity = world.Cloth(0).velocities()[0];
    for (int k = 0; k < 60; ++k) world.Step();
    const double way = Length(world.Cloth(0).positions()[0] - before);
    if (friction > 0.5) {
      CHECK(way < 1e-5);
    } else {
      const double gain = Length(world.Cloth(0).velocities()[0]) - Length(velocity);
      CHECK(gain == doctest::Approx(9.8 * (1 - 0.45 * 2) / std::sqrt(5.0)).epsilon(0.01));
    }
  }
}

TEST_CASE("cloth that is folded onto itself passes through nothing") {
  World world(FoldScene(), {.threads = 1});
  ClothJudge judge(world, 1);
  std::int64_t contacts = 0, onColliders = 0;
  for (int k = 0; k < kFoldFrames; ++k) {
    CAPTURE(k);
    const StepReport& report = world.Step();
    REQUIRE(!report.divergence);
    contacts += report.selfContacts, onColliders += report.colliderContacts;
    CHECK(judge.Count(world).count == 0);
  }
  CHECK(contacts > 1000);
  CHECK(onColliders > 100);
}

TEST_CASE("contact comes out to the same bits for any number of threads") {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    World world(FoldScene(), {.threads = threads});
    for (int k = 0; k < kFoldFrames; ++k) world.Step();
    hashes.push_back(world.StateHash());
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

TEST_CASE("a state with contact, friction and a moving collider goes on to the same bits") {
  World world(FoldScene(), {.threads = 1});
  for (int k = 0; k < kFoldFrames / 2; ++k) world.Step();
  WorldState state;
  SUBCASE("as it is") {}
  SUBCASE("after cloth was put elsewhere") {
    world.Place({.cloth = 1, .vertex = 0, .target = world.Cloth(1).positions()[0] + Vec3{0, 0.004, 0}});
  }
  world.Save(state);
  CHECK(state.touches.size() > 10);
  const auto goOn = [](World& from) {
    for (int k = 0; k < kFoldFrames / 2; ++k) from.Step();
    return from.StateHash();
  };
  const std::uint64_t hash = goOn(world);

  world.Restore(state);
  CHECK(goOn(world) == hash);

  World fresh(FoldScene(), {.threads = 1});
  fresh.Restore(state);
  CHECK(goOn(fresh) == hash);

  const Result<WorldState> read = ParseCheckpoint(FormatCheckpoint(state), "memory");
  if (!read) MESSAGE(Format(read.diagnostics()));
  REQUIRE(read);
  World other(*read->scene, {.threads = 1});
  other.Restore(*read);
  CHECK(goOn(other) == hash);
}

TEST_CASE("memory of contact grows with what is near, says so, and is kept") {
  Scene scene = FabricScene(60);
  scene.cloths.push_back(Sheet(0.3, 0.3, 15, 15));
  scene.cloths[0].origin = {0, -0.9, 0};
  ColliderSettings post;
  post.shape = ColliderShape::Box;
  post.size = {0.02, 0.1, 0.02};
  post.position = {0.15, 0.03, 0.15};
  scene.colliders.push_back(post);
  scene.planes.push_back({.point = {0, 0, 0}, .normal = {0, 1, 0}, .friction = 0.3});
  World world(scene, {.threads = 1});
  std::int64_t first = 0, last = 0, contacts = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const StepReport& report = world.Step();
    CHECK(report.contactBytes >= last);
    last = report.contactBytes;
    if (frame == 0) first = last;
    contacts = std::max(contacts, report.selfContacts + report.colliderContacts);
  }
  CHECK(contacts > 50);
  CHECK(first > 0);
  CHECK(last > first + contacts * std::int64_t(sizeof(double)));
}

TEST_CASE("a step that is done over in parts ends as a step, and nothing else feels it") {
  for (int start = 0; start < test::Fewer(4, 1); ++start) {
    CAPTURE(start);
    World shot(ShotScene(true, 0.006 * start), {.threads = 1}), calm(ShotScene(false, 0), {.threads = 1});
    ClothJudge judge(shot, 1);
    int splits = 0;
    double stretch = 0, off = 0;
    for (int k = 0; k < kShotFrames; ++k) {
      CAPTURE(k);
      const StepReport& report = shot.Step();
      REQUIRE(!report.divergence);
      splits += report.splits;
      stretch = std::max(stretch, report.greatestStretch);
      CHECK(judge.Count(shot).count == 0);
      CHECK(calm.Step().splits == 0);
      // What falls freely has the velocity that its weight gave it, 3.3 m/s at last, to within a hundredth.
      for (const Vec3& velocity : shot.Cloth(1).velocities())
        off = std::max(off, Length(velocity - Vec3{0, -9.8, 0} * report.time));
    }
    CHECK(splits > 0);
    CHECK(off < 0.033);
    // The ball carries it 1 m from its pins, and the ways to them are 0.28 m of cloth.
    CHECK(stretch < 4);
    if (!test::kSanitized) CHECK(shot.report().greatestStretch < 1.5);
  }
}

TEST_CASE("a step in parts comes out to the same bits for any number of threads, and from a checkpoint") {
  std::vector<std::uint64_t> hashes;
  WorldState middle;
  for (const int threads : {1, 3}) {
    World world(ShotScene(true, 0.006), {.threads = threads});
    for (int k = 0; k < 9; ++k) {
      if (k == 5) world.Save(middle);
      world.Step();
    }
    hashes.push_back(world.StateHash());
  }
  CHECK(hashes[0] == hashes[1]);
  World world(ShotScene(true, 0.006), {.threads = 1});
  world.Restore(middle);
  for (int k = 5; k < 9; ++k) world.Step();
  CHECK(world.StateHash() == hashes[0]);
}
