#include "percale/world.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "percale/parameters.h"
#include "tests/springs/scenes.h"

using namespace percale;
using namespace percale::test;

namespace {

/// A scene with something of every kind.
Scene FullScene() {
  Scene scene = CourseScene("pinned2", 16);
  scene.spheres.push_back({{0.5, 0.6, 0.5}, 0.2, 0.3});
  scene.planes.push_back({{0, 0.2, 0}, {0, 1, 0.1}, 0.5});
  scene.pinMotions.push_back({0, {{15, 0}}, 0.1, 0.4, {-0.2, 0.1, 0}});
  scene.wind = {{1, 0, 2}, 0.5, 0.3, 0.8};
  return scene;
}

std::vector<Vec3> Positions(const World& world, int cloth = 0) {
  const auto x = world.Cloth(cloth).positions();
  return {x.begin(), x.end()};
}

/// Another value that the parameter may have, or nothing.
std::optional<Value> OtherValue(const Parameter& parameter, const Value& now) {
  std::vector<Value> candidates;
  switch (parameter.kind) {
    case ValueKind::Number:
    case ValueKind::Integer:
      for (const double v : {parameter.typicalMin, parameter.typicalMax, 0.5, 1.0, 2.0, 7.0})
        candidates.emplace_back(v);
      break;
    case ValueKind::Boolean:
      for (const bool v : {true, false}) candidates.emplace_back(v);
      break;
    case ValueKind::Choice:
      for (const std::string_view choice : parameter.choices) candidates.emplace_back(std::string(choice));
      break;
    case ValueKind::Text:
      candidates.emplace_back(std::string("Phong"));
      break;
    case ValueKind::Vector:
      candidates.emplace_back(Vec3{0.25, 0.5, 0.125});
      break;
    case ValueKind::GridPoints:
      candidates.emplace_back(std::vector<GridPoint>{{15, 0}, {3, 3}});
      candidates.emplace_back(std::vector<GridPoint>{{0, 0}});
      break;
  }
  for (const Value& candidate : candidates) {
    if (candidate != now && !CheckValue(parameter, candidate)) return candidate;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("a frame is stepsPerFrame steps, and the report counts them") {
  Scene scene = SmallScene(4, 4);
  scene.simulation.framesPerSecond = 50;
  scene.simulation.stepsPerFrame = 7;
  World world(scene);
  CHECK(world.report().frame == 0);
  CHECK(world.report().step == 0);
  CHECK(world.report().time == 0);
  Run(world, 25);
  CHECK(world.report().frame == 25);
  CHECK(world.report().step == 175);
  CHECK(world.report().time == doctest::Approx(0.5).epsilon(1e-12));
  double seconds = 0;
  for (const double stage : world.report().stageSeconds) {
    CHECK(stage >= 0);
    seconds += stage;
  }
  CHECK(seconds > 0);
}

TEST_CASE("energies of a cloth in free fall: what gravity gives up, motion takes") {
  Scene scene = SmallScene(4, 3);
  scene.cloths[0].damping = 0;
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].origin.y = 10;
  scene.cloths[1].density = 20;
  World world(scene);
  Run(world, 30);
  const double area = scene.cloths[0].width * scene.cloths[0].height, g = 9.8, t = world.report().time;
  const double dt = scene.TimeStep(), fallen = 0.5 * g * t * (t + dt);  // Verlet from rest
  const double mass[2] = {area * scene.cloths[0].density, area * 20};
  const double potential = g * (mass[0] * (1 - fallen) + mass[1] * (11 - fallen));
  CHECK(world.report().potentialEnergy == doctest::Approx(potential).epsilon(1e-9));
  CHECK(world.report().kineticEnergy == doctest::Approx(0.5 * (mass[0] + mass[1]) * g * t * g * t).epsilon(1e-9));
  CHECK(world.report().elasticEnergy == doctest::Approx(0).epsilon(1e-12));
}

TEST_CASE("the elastic energy of a sheet that its pins have pulled 5% wider") {
  Scene scene = SmallScene(3, 2);
  ClothSettings& cloth = scene.cloths[0];
  cloth.width = 0.4;  // three columns 0.2 m apart, two rows 0.1 m apart
  cloth.height = 0.1;
  cloth.pinned = {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}};
  scene.pinMotions.push_back({0, {{1, 0}, {1, 1}}, 0, 0.1, {0.01, 0, 0}});
  scene.pinMotions.push_back({0, {{2, 0}, {2, 1}}, 0, 0.1, {0.02, 0, 0}});
  World world(scene);
  Run(world, 20);
  REQUIRE(world.report().time > 0.1);
  const double structural = 4 * 0.01 * 0.01;  // both halves of both rows
  const double diagonal = std::hypot(0.21, 0.1) - std::hypot(0.2, 0.1), shearing = 4 * diagonal * diagonal;
  const double bending = 0.2 * 2 * 0.02 * 0.02;  // a fifth of ks, across both halves
  CHECK(world.report().elasticEnergy ==
        doctest::Approx(0.5 * cloth.ks * (structural + shearing + bending)).epsilon(1e-9));
  scene.cloths[0].enableShearing = false;
  world.Apply(scene);
  world.Step();
  CHECK(world.report().elasticEnergy == doctest::Approx(0.5 * cloth.ks * (structural + bending)).epsilon(1e-9));
}

TEST_CASE("every stage has a name of its own") {
  std::set<std::string_view> names;
  for (int s = 0; s < kStageCount; ++s) names.insert(StageName(static_cast<Stage>(s)));
  CHECK(names.size() == kStageCount);
  CHECK(StageName(Stage::LimitStrain) == "LimitStrain");
}

TEST_CASE("the report agrees with what the cloth shows") {
  Scene scene = FullScene();
  World world(scene);
  std::vector<Vec3> before = Positions(world);
  const double mass = 150.0 / (16 * 16);
  for (int frame = 0; frame < 30; ++frame) {
    const StepReport& report = world.Step();
    const ClothView cloth = world.Cloth(0);
    double move = 0, energy = 0, stretch = 0;
    for (std::size_t v = 0; v < before.size(); ++v) {
      move = std::max(move, Length(cloth.positions()[v] - before[v]));
      energy += 0.5 * mass * Dot(cloth.velocities()[v], cloth.velocities()[v]);
    }
    for (const Edge& e : cloth.springs()) {
      const auto a = static_cast<std::size_t>(e.a), b = static_cast<std::size_t>(e.b);
      const Vec2 d{cloth.uv()[a].x - cloth.uv()[b].x, cloth.uv()[a].y - cloth.uv()[b].y};
      stretch = std::max(stretch, Length(cloth.positions()[a] - cloth.positions()[b]) / std::hypot(d.x, d.y));
    }
    CHECK(report.greatestMove == doctest::Approx(move).epsilon(1e-9));
    CHECK(report.kineticEnergy == doctest::Approx(energy).epsilon(1e-9));
    CHECK(report.greatestStretch == doctest::Approx(stretch).epsilon(1e-9));
    before = Positions(world);
  }
  CHECK(world.report().kineticEnergy > 0);
}

TEST_CASE("a view shows the enabled springs, the triangles and the pins") {
  Scene scene = SmallScene(4, 3);
  scene.cloths[0].pinned = {{3, 2}, {0, 0}};
  World world(scene);
  ClothView cloth = world.Cloth(0);
  CHECK(cloth.positions().size() == 12);
  CHECK(cloth.velocities().size() == 12);
  CHECK(cloth.uv().size() == 12);
  CHECK(cloth.triangles().size() == 12);
  CHECK(cloth.springs().size() == 17 + 12 + 10);
  REQUIRE(cloth.pinned().size() == 2);
  CHECK(cloth.pinned()[0] == 0);
  CHECK(cloth.pinned()[1] == 11);
  scene.cloths[0].enableShearing = false;
  CHECK(world.Apply(scene));
  CHECK(world.Cloth(0).springs().size() == 17 + 10);
}

TEST_CASE("Reset equals a new World, to the bit") {
  for (Scene scene : {FullScene(), CourseScene("selfCollision", 20)}) {
    World world(scene, {.threads = 2});
    const std::uint64_t start = world.StateHash();
    Run(world, 45);
    const std::uint64_t end = world.StateHash();
    CHECK(end != start);
    world.Reset();
    CHECK(world.StateHash() == start);
    CHECK(world.report().frame == 0);
    CHECK(world.report().time == 0);
    CHECK(world.report().kineticEnergy == 0);
    for (const Vec3& v : world.Cloth(0).velocities()) CHECK(v == Vec3{});
    Run(world, 45);
    CHECK(world.StateHash() == end);

    // With settings that were changed meanwhile: like a new World with those.
    scene.cloths[0].ks = 700;
    scene.cloths[0].thickness *= 0.5;
    scene.wind.drag = 0.2;
    scene.simulation.stepsPerFrame = 20;
    scene.pinMotions.clear();
    REQUIRE(world.Apply(scene));
    Run(world, 10);
    world.Reset();
    World fresh(scene);
    CHECK(world.StateHash() == start);
    Run(world, 20);
    Run(fresh, 20);
    CHECK(world.StateHash() == fresh.StateHash());
  }
}

TEST_CASE("Apply starts anew for every parameter that makes another cloth, and keeps the state for every other") {
  const Scene scene = FullScene();
  int kept = 0, restarted = 0;
  for (const Parameter& parameter : Parameters()) {
    const std::string path = std::string(parameter.group) + "." + std::string(parameter.name);
    CAPTURE(path);
    const ParameterGroup* group = FindGroup(parameter.group);
    REQUIRE(group != nullptr);
    if (group->count(scene) == 0) continue;
    const std::optional<Value> other = OtherValue(parameter, parameter.get(scene, 0));
    if (!other) continue;
    Scene changed = scene;
    parameter.set(changed, 0, *other);
    if (HasErrors(CheckScene(changed))) continue;
    World world(scene, {.threads = 1});
    Run(world, 5);
    const std::vector<Vec3> before = Positions(world);
    const bool keep = world.Apply(changed);
    CHECK(keep == (parameter.effect != Effect::Rebuild));
    CHECK(parameter.get(world.scene(), 0) == *other);
    if (keep) {
      ++kept;
      CHECK(Positions(world) == before);
      CHECK(world.report().frame == 5);
      Run(world, 5);
      CHECK(AllFinite(world));
    } else {
      ++restarted;
      World fresh(changed, {.threads = 1});
      CHECK(Positions(world) == Positions(fresh));
      CHECK(world.report().frame == 0);
      Run(world, 5);
      Run(fresh, 5);
      CHECK(world.StateHash() == fresh.StateHash());
    }
  }
  CHECK(kept >= 25);
  CHECK(restarted >= 6);
}

TEST_CASE("Apply with other colliders, motions and cloths") {
  Scene scene = FullScene();
  World world(scene);
  Run(world, 5);
  const std::vector<Vec3> before = Positions(world);
  scene.spheres.push_back({{0.2, 0.5, 0.2}, 0.1, 0});
  scene.planes.clear();
  CHECK(world.Apply(scene));
  CHECK(Positions(world) == before);
  Run(world, 5);
  scene.spheres.clear();
  scene.planes = {{{0, 0, 0}, {0, 1, 0}, 0.5}, {{0, 0, -1}, {0, 0, 1}, 0.5}};
  scene.pinMotions.push_back({0, {}, 1, 2, {0, 1, 0}});
  CHECK(world.Apply(scene));
  Run(world, 5);
  CHECK(world.report().frame == 15);

  scene.cloths.push_back(CourseScene("sphere", 10).cloths[0]);
  CHECK_FALSE(world.Apply(scene));
  CHECK(world.ClothCount() == 2);
  CHECK(world.report().frame == 0);
  World fresh(scene);
  Run(world, 5);
  Run(fresh, 5);
  CHECK(world.StateHash() == fresh.StateHash());
  scene.cloths.pop_back();
  CHECK_FALSE(world.Apply(scene));
  CHECK(world.ClothCount() == 1);
}

TEST_CASE("two Worlds side by side do not disturb each other") {
  const Scene scenes[2] = {FullScene(), CourseScene("selfCollision", 24)};
  std::uint64_t alone[2];
  for (int k : {0, 1}) {
    World world(scenes[k]);
    Run(world, 30);
    alone[k] = world.StateHash();
  }
  World a(scenes[0]), b(scenes[1], {.threads = 2});
  for (int frame = 0; frame < 30; ++frame) {
    a.Step();
    b.Step();
  }
  CHECK(a.StateHash() == alone[0]);
  CHECK(b.StateHash() == alone[1]);
}

TEST_CASE("a World can be moved") {
  World first(FullScene());
  Run(first, 3);
  World second = std::move(first);
  World expected(FullScene());
  Run(expected, 6);
  Run(second, 3);
  CHECK(second.StateHash() == expected.StateHash());
  World third(SmallScene(2, 2));
  third = std::move(second);
  CHECK(third.StateHash() == expected.StateHash());
}

TEST_CASE("the fingerprint tells states apart") {
  World a(SmallScene(4, 4)), b(SmallScene(4, 4));
  CHECK(a.StateHash() == b.StateHash());
  a.Step();
  CHECK(a.StateHash() != b.StateHash());
  Scene moved = SmallScene(4, 4);
  moved.cloths[0].origin.z = 1e-15;  // the least change
  CHECK(World(moved).StateHash() != b.StateHash());
}

TEST_CASE("at rest: thirty frames on end without a move of more than a millimetre") {
  Scene still = SmallScene(3, 3);
  still.simulation.gravity = {};
  World world(still);
  Run(world, 29);
  CHECK_FALSE(world.report().atRest);
  world.Step();
  CHECK(world.report().atRest);
  CHECK(world.Apply(still));  // whatever changes, it has to prove itself again
  CHECK_FALSE(world.report().atRest);
  Run(world, 29);
  CHECK_FALSE(world.report().atRest);

  World falling(SmallScene(3, 3));
  for (int frame = 0; frame < 60; ++frame) CHECK_FALSE(falling.Step().atRest);

  World hanging(CourseScene("pinned4", 12));
  int rest = 0;
  for (int frame = 0; frame < 1000 && rest == 0; ++frame) rest = hanging.Step().atRest ? frame : 0;
  CHECK(rest > 30);
  Run(hanging, 100);
  CHECK(hanging.report().atRest);
}

TEST_CASE("pins follow their motion smoothly and end where it leads") {
  Scene scene = SmallScene(5, 5);
  scene.cloths[0].pinned = {{0, 0}, {4, 0}, {2, 2}};
  scene.pinMotions = {{0, {{0, 0}, {4, 0}}, 0.1, 0.5, {0, 0.2, 0.1}}, {0, {{4, 0}}, 0.2, 0.6, {-0.1, 0, 0}}};
  World world(scene);
  const std::vector<Vec3> start = Positions(world);
  Run(world, 9);  // 0.1 s
  CHECK(Length(world.Cloth(0).positions()[0] - start[0]) < 1e-12);
  Run(world, 18);  // 0.3 s: half of the way
  CHECK(Length(world.Cloth(0).positions()[0] - start[0] - Vec3{0, 0.1, 0.05}) < 1e-9);
  // At half time a smooth way is at 1.5 times its mean speed.
  const Vec3 velocity = world.Cloth(0).velocities()[0];
  CHECK(velocity.y == doctest::Approx(1.5 * 0.2 / 0.4).epsilon(1e-4));
  Run(world, 33);  // 0.667 s
  CHECK(Length(world.Cloth(0).positions()[0] - start[0] - Vec3{0, 0.2, 0.1}) < 1e-12);
  CHECK(Length(world.Cloth(0).positions()[4] - start[4] - Vec3{-0.1, 0.2, 0.1}) < 1e-12);
  CHECK(world.Cloth(0).positions()[12] == start[12]);
  CHECK(world.Cloth(0).velocities()[0] == Vec3{});
}
