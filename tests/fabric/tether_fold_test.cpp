// Ropes and folds that stay, run through a World as scenes have them.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "percale/parameters.h"
#include "percale/world.h"
#include "tests/fabric/cotton_scene.h"
#include "tests/sanitized.h"

using namespace percale;

namespace {

Scene Sheet(int points, BendingLaw law = BendingLaw::Quadratic) {
  Scene scene = test::CottonScene();
  scene.wind.airDensity = 0;
  ClothSettings& cloth = scene.cloths[0];
  cloth.numWidthPoints = cloth.numHeightPoints = points;
  cloth.bendingLaw = law;
  return scene;
}

/// Angle between the two triangles of a sheet of 2 x 2 points, 0 where flat [rad].
double AngleOfTwo(const ClothView& cloth) {
  const auto normal = [&](const Triangle& t) {
    const std::span<const Vec3> x = cloth.positions();
    const Vec3 a = x[static_cast<std::size_t>(t.a)];
    const Vec3 n = Cross(x[static_cast<std::size_t>(t.b)] - a, x[static_cast<std::size_t>(t.c)] - a);
    return n / Length(n);
  };
  return std::acos(Dot(normal(cloth.triangles()[0]), normal(cloth.triangles()[1])));
}

/// Two triangles, all corners pinned, one of them lifted by `way` within a second and brought back in the next.
Scene FoldedByHand(double way, double yieldAngle, double hardening) {
  Scene scene = Sheet(2, BendingLaw::Hinges);
  ClothSettings& cloth = scene.cloths[0];
  cloth.pinned = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  cloth.foldYield = yieldAngle / (2 * 0.5 / std::sqrt(2.0));  // over the width (A + A) / |e| of the diagonal
  cloth.foldHardening = hardening;
  // The corners off the diagonal: of which one stays, and one is moved.
  World world(scene);
  const Triangle& t = world.Cloth(0).triangles()[0];
  const Triangle& other = world.Cloth(0).triangles()[1];
  std::int32_t lifted = -1;
  for (const std::int32_t v : {t.a, t.b, t.c}) {
    if (v != other.a && v != other.b && v != other.c) lifted = v;
  }
  const Vec3 up = cloth.orientation == Orientation::Horizontal ? Vec3{0, way, 0} : Vec3{0, 0, way};
  scene.pinMotions.push_back({0, {{lifted % 2, lifted / 2}}, 0, 1, up});
  scene.pinMotions.push_back({0, {{lifted % 2, lifted / 2}}, 1, 2, -up});
  return scene;
}

Fold OnlyFold(const World& world) {
  WorldState state;
  world.Save(state);
  REQUIRE(state.cloths[0].folds.size() == 1);
  return state.cloths[0].folds[0];
}

}  // namespace

TEST_CASE("a fold sets by what it is bent beyond its yield, less what it has hardened") {
  for (const double hardening : {0.0, 0.5}) {
    constexpr double kYield = 0.2;
    World world(FoldedByHand(0.5, kYield, hardening));
    double largest = 0;
    for (int frame = 0; frame < 60; ++frame) {
      REQUIRE(!world.Step().divergence);
      const double angle = AngleOfTwo(world.Cloth(0));
      largest = std::max(largest, angle);
      const double moved = std::max(0.0, (angle - kYield) / (1 + hardening));
      CHECK(OnlyFold(world).moved == doctest::Approx(moved).epsilon(1e-6));
      CHECK(std::abs(OnlyFold(world).rest) == doctest::Approx(moved).epsilon(1e-6));
    }
    REQUIRE(largest > 0.5);
    // Brought back flat it has the set part to bear, which sets back as far as that is beyond what it bears now.
    const double set = (largest - kYield) / (1 + hardening), bears = kYield + hardening * set;
    const double back = std::max(0.0, (set - bears) / (1 + hardening));
    for (int frame = 0; frame < 61; ++frame) world.Step();
    CHECK(AngleOfTwo(world.Cloth(0)) == doctest::Approx(0));
    CHECK(std::abs(OnlyFold(world).rest) == doctest::Approx(set - back).epsilon(1e-3));
    CHECK(OnlyFold(world).moved == doctest::Approx(set + back).epsilon(1e-3));
  }
}

TEST_CASE("below its yield a fold is as new, and Reset makes it so") {
  World gentle(FoldedByHand(0.5, 2.5, 0));
  for (int frame = 0; frame < 60; ++frame) gentle.Step();
  CHECK(OnlyFold(gentle) == Fold{});
  World rough(FoldedByHand(0.5, 0.1, 0));
  for (int frame = 0; frame < 60; ++frame) rough.Step();
  CHECK(OnlyFold(rough).moved > 0.2);
  rough.Reset();
  CHECK(OnlyFold(rough) == Fold{});
}

TEST_CASE("what has set is a part of the state, and the same for any number of threads") {
  Scene scene = Sheet(24, BendingLaw::Hinges);
  scene.cloths[0].pinned = {{0, 0}, {5, 0}};
  scene.cloths[0].foldYield = 3;
  scene.cloths[0].foldHardening = 0.3;
  std::optional<WorldState> end;
  for (const int threads : {1, 3}) {
    World world(scene, {.threads = threads});
    for (int frame = 0; frame < 15; ++frame) world.Step();
    WorldState middle, after;
    world.Save(middle);
    double moved = 0;
    for (const Fold& fold : middle.cloths[0].folds) moved += fold.moved;
    CHECK(moved > 0.1);
    for (int frame = 0; frame < 15; ++frame) world.Step();
    world.Save(after);
    World other(scene, {.threads = threads});
    other.Step();
    other.Restore(middle);
    for (int frame = 0; frame < 15; ++frame) other.Step();
    WorldState again;
    other.Save(again);
    CHECK(other.StateHash() == world.StateHash());
    CHECK(again.cloths[0].folds == after.cloths[0].folds);
    if (!end) end = after;
    CHECK(end->cloths[0].folds == after.cloths[0].folds);
    CHECK(end->cloths[0].positions == after.cloths[0].positions);
  }
  // Where none sets there is nothing to keep.
  scene.cloths[0].foldYield = 0;
  World plain(scene);
  plain.Step();
  WorldState state;
  plain.Save(state);
  CHECK(state.cloths[0].folds.empty());
}

TEST_CASE("a sheet that hangs from ropes draws them out by its weight over their stiffness" *
          doctest::skip(test::kSanitized)) {
  for (const int ropes : {1, 2}) {
    Scene scene = Sheet(9);
    Tether tether{.cloth = 0, .points = {{0, 0}}, .anchor = {0.5, 1.6, 0}, .length = 0.25, .stiffness = 200};
    if (ropes == 2) tether.points.push_back({8, 0});
    scene.tethers.push_back(tether);
    scene.cloths[0].stretchDamping = 0.02;
    scene.simulation.newtonIterations = 8;
    scene.simulation.linearIterations = 30;
    World world(scene);
    for (int frame = 0; frame < 1500; ++frame) REQUIRE(!world.Step().divergence);
    const std::span<const Vec3> x = world.Cloth(0).positions();
    double up = 0;  // of all ropes' force
    for (const GridPoint& point : tether.points) {
      const Vec3 way = tether.anchor - x[static_cast<std::size_t>(point.i)];
      CHECK(Length(way) > tether.length);
      up += tether.stiffness * (Length(way) - tether.length) * way.y / Length(way);
    }
    CHECK(up == doctest::Approx(scene.cloths[0].density * 9.8).epsilon(0.01));
  }
}

TEST_CASE("a slack rope is not there") {
  Scene scene = Sheet(9);
  World falling(scene);
  scene.tethers.push_back({.cloth = 0, .points = {{4, 4}}, .anchor = {0.5, 1, 0.5}, .length = 1});
  World roped(scene);
  bool taut = false;
  for (int frame = 0; frame < 60 && !taut; ++frame) {
    falling.Step(), roped.Step();
    taut = Length(falling.Cloth(0).positions()[40] - scene.tethers[0].anchor) > 1;
    CHECK((falling.StateHash() == roped.StateHash()) == !taut);
  }
  CHECK(taut);
}

TEST_CASE("ropes that cannot be are told") {
  const auto told = [](auto&& change) {
    Scene scene = Sheet(4);
    scene.tethers.push_back({.cloth = 0, .points = {{1, 1}}, .anchor = {}, .length = 1});
    change(scene);
    return Format(CheckScene(scene));
  };
  CHECK(told([](Scene&) {}).find("tether") == std::string::npos);
  CHECK(told([](Scene& s) {
          s.tethers[0].points = {{4, 1}};
        }).find("/tether/0/points/0: expected") != std::string::npos);
  CHECK(told([](Scene& s) { s.tethers[0].points.clear(); }).find("at least one point") != std::string::npos);
  CHECK(told([](Scene& s) { s.tethers[0].cloth = 1; }).find("/tether/0/cloth") != std::string::npos);
  CHECK(told([](Scene& s) { s.simulation.engine = Engine::Springs; }).find("only the engine \"fabric\"") !=
        std::string::npos);
  CHECK(told([](Scene& s) { s.cloths[0].foldYield = 5; }).find("bending_law quadratic") != std::string::npos);
}

TEST_CASE("pins that are carried farther apart than the cloth can stretch are told, with the worst pair and when") {
  Scene scene = Sheet(5);
  scene.cloths[0].pinned = {{0, 0}, {4, 0}, {0, 4}};
  const auto said = [&] { return Format(CheckScene(scene)); };
  // Carried all together, or within what the yarns bear.
  scene.pinMotions.push_back({0, {}, 0, 1, {5, 0, 0}});
  CHECK(said() == "");
  scene.pinMotions.push_back({0, {{4, 0}}, 0, 2, {0.15, 0, 0}});
  CHECK(said() == "");
  scene.pinMotions.push_back({0, {{4, 0}}, 2, 3, {0.85, 0, 0}});
  CHECK(
      said().find("/pin_motion: pins [0, 0] and [4, 0] are carried 2 m apart at 3 s, with 1 m of cloth between them") !=
      std::string::npos);
  // Apart for a while only.
  scene.pinMotions.push_back({0, {{4, 0}}, 3, 4, {-1, 0, 0}});
  CHECK(said().find("at 3 s") != std::string::npos);
  // The springs of the course have no such limit.
  scene.simulation.engine = Engine::Springs;
  CHECK(said().find("carried") == std::string::npos);
}
