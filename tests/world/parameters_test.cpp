#include "percale/parameters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/text.h"
#include "world/limits.h"

namespace percale {
namespace {

Scene OneOfEach() {
  Scene scene;
  for (const ParameterGroup& group : ParameterGroups()) group.resize(scene, 1);
  scene.cloths[0].pinned = {{0, 0}, {49, 0}};  // a motion needs a pin that it moves
  scene.tethers[0].points = {{2, 3}};
  return scene;
}

/// A valid value other than `old`, or `old` where there is only one.
Value Another(const Parameter& p, const Value& old) {
  switch (p.kind) {
    case ValueKind::Number: {
      const double high = std::isfinite(p.max) ? p.max : 1e3, low = std::isfinite(p.min) ? p.min : -1e3;
      return low + (high - low) * 0.37;
    }
    case ValueKind::Integer:
      return std::get<double>(old) == p.min ? p.min + 1 : p.min;
    case ValueKind::Boolean:
      return !std::get<bool>(old);
    case ValueKind::Choice:
      return std::string(p.choices.back());
    case ValueKind::Text:
      return std::string("Mirror");
    case ValueKind::Vector:
      return Vec3{p.max * 0.25, p.max * 0.5, p.max};
    case ValueKind::GridPoints:
      break;
  }
  return std::vector<GridPoint>{{1, 2}, {3, 4}};
}

bool Mentions(const Diagnostics& diagnostics, Severity severity, const std::string& text) {
  for (const Diagnostic& d : diagnostics) {
    if (d.severity == severity && d.message.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST_CASE("Every parameter reads back what was set, and nothing else changes") {
  for (const Parameter& p : Parameters()) {
    CAPTURE(std::string(p.group) + "." + std::string(p.name));
    Scene scene = OneOfEach();
    const Value changed = Another(p, p.get(scene, 0));
    REQUIRE_FALSE(CheckValue(p, changed).has_value());
    p.set(scene, 0, changed);
    CHECK(p.get(scene, 0) == changed);
    const Scene untouched = OneOfEach();
    for (const Parameter& other : Parameters()) {
      if (&other != &p) CHECK(other.get(scene, 0) == other.get(untouched, 0));
    }
  }
}

TEST_CASE("The index chooses the object") {
  Scene scene;
  scene.cloths.resize(3);
  const Parameter* ks = FindParameter("cloth", "ks");
  REQUIRE(ks);
  ks->set(scene, 1, 7.0);
  CHECK(scene.cloths[0].ks == 5000);
  CHECK(scene.cloths[1].ks == 7);
  CHECK(scene.cloths[2].ks == 5000);
}

TEST_CASE("Names are unique, groups exist, defaults are in range, and everything is explained") {
  std::set<std::string> seen;
  for (const Parameter& p : Parameters()) {
    const std::string name = std::string(p.group) + "." + std::string(p.name);
    CAPTURE(name);
    CHECK(seen.insert(name).second);
    CHECK(FindGroup(p.group) != nullptr);
    CHECK(FindParameter(p.group, p.name) == &p);
    CHECK_FALSE(p.label.empty());
    CHECK(p.help.size() > 10);
    CHECK(p.help.back() == '.');
    CHECK(p.typicalMin <= p.typicalMax);
    if (p.typicalMin < p.typicalMax) {
      CHECK(p.typicalMin >= p.min);
      CHECK(p.typicalMax <= p.max);
    }
    if (p.logarithmic) CHECK(p.typicalMin > 0);
    // A plane's default normal aside, zero is the default of everything that a file must state.
    if (p.name != "end") CHECK_MESSAGE(!CheckValue(p, DefaultValue(p)).has_value(), name);
  }
  CHECK(FindParameter("cloth", "gravity") == nullptr);
  CHECK(FindGroup("clothes") == nullptr);
}

TEST_CASE("Only what keeps the grid and its start the same acts on a running cloth") {
  const std::set<std::string_view> rebuild = {
      "shape",         "width",      "height",     "num_width_points", "num_height_points",
      "orientation",   "origin",     "seed",       "radius",           "rings",
      "mesh",          "mesh_scale", "rest_shape", "metres_per_uv",    "weld",
      "weld_distance", "rotation",   "warp_angle", "bending_law"};
  for (const Parameter& p : Parameters()) {
    const bool isOther =
        p.group == "collider" && (p.name == "shape" || p.name == "mesh" || p.name == "mesh_scale" || p.name == "cache");
    const bool expected = (p.group == "cloth" && rebuild.count(p.name) > 0) || isOther || p.name == "engine";
    CHECK_MESSAGE((p.effect == Effect::Rebuild) == expected, p.name);
    const bool isView = p.group == "camera" || p.group == "look" || (p.group == "collider" && p.name == "color");
    CHECK_MESSAGE((p.effect == Effect::View) == isView, p.name);
  }
}

TEST_CASE("What differs between two scenes is told value by value, and has the greatest effect of them") {
  const Scene scene = OneOfEach();
  CHECK(Differences(scene, scene).empty());
  CHECK(EffectOf(scene, scene) == std::nullopt);
  for (const Parameter& p : Parameters()) {
    CAPTURE(p.name);
    Scene changed = scene;
    p.set(changed, 0, Another(p, p.get(scene, 0)));
    const std::vector<Difference> differences = Differences(scene, changed);
    if (p.get(changed, 0) == p.get(scene, 0)) continue;  // It has one value only.
    REQUIRE(differences.size() == 1);
    CHECK(differences[0].parameter == &p);
    CHECK(differences[0].index == 0);
    CHECK(EffectOf(scene, changed) == p.effect);
    changed.look.color.x += 0.125;
    CHECK(EffectOf(scene, changed) == p.effect);
  }
  Scene more = scene;
  more.spheres.push_back({});
  const auto ofSpheres = [](const Difference& d) { return d.parameter->group == "sphere" && d.index == 1; };
  for (const std::vector<Difference>& differences : {Differences(scene, more), Differences(more, scene)}) {
    CHECK_FALSE(differences.empty());
    CHECK(std::all_of(differences.begin(), differences.end(), ofSpheres));
  }
}

TEST_CASE("Every bound is enforced, NaN and infinity are out of every range") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Parameter& p : Parameters()) {
    CAPTURE(std::string(p.group) + "." + std::string(p.name));
    std::vector<double> bad = {std::nan(""), kInfinity, -kInfinity, 1e308, -1e308};
    if (p.kind == ValueKind::Integer) bad.push_back(p.min + 0.5);
    if (p.minExclusive) bad.push_back(p.min);
    bad.push_back(std::nextafter(p.min, -kInfinity));
    bad.push_back(std::nextafter(p.max, kInfinity));
    for (const double number : bad) {
      CAPTURE(number);
      if (p.kind == ValueKind::Number || p.kind == ValueKind::Integer) CHECK(CheckValue(p, number).has_value());
      if (p.kind == ValueKind::Vector) {
        const double fine = 0.5;
        CHECK(CheckValue(p, Vec3{number, fine, fine}).has_value());
        CHECK(CheckValue(p, Vec3{fine, number, fine}).has_value());
        CHECK(CheckValue(p, Vec3{fine, fine, number}).has_value());
      }
    }
    if (p.kind == ValueKind::Number || p.kind == ValueKind::Integer) {
      CHECK_FALSE(CheckValue(p, p.max).has_value());
      if (!p.minExclusive) CHECK_FALSE(CheckValue(p, p.min).has_value());
    }
    // A value of any other kind is none of this one.
    const Value kinds[] = {0.5, true, std::string("x"), Vec3{}, std::vector<GridPoint>{}};
    for (const Value& value : kinds) {
      if (value.index() != p.get(OneOfEach(), 0).index()) CHECK(CheckValue(p, value).has_value());
    }
  }
}

TEST_CASE("A problem says what was expected, with the unit, and what was found") {
  const Parameter& ks = *FindParameter("cloth", "ks");
  CHECK(CheckValue(ks, -5.0) == "expected a number >= 0 N/m, got -5");
  CHECK(CheckValue(ks, 1e308) == "expected a number from 0 to 1000000000000 N/m, got 1e308");
  CHECK(CheckValue(ks, std::nan("")) == "expected a number >= 0 N/m, got NaN");
  CHECK(CheckValue(*FindParameter("cloth", "width"), 0.0) == "expected a number > 0 m, got 0");
  CHECK(CheckValue(*FindParameter("cloth", "damping"), 101.0) == "expected a number from 0 to 100 %, got 101");
  CHECK(CheckValue(*FindParameter("cloth", "orientation"), 2.0) == "expected 0 (horizontal) or 1 (vertical), got 2");
  CHECK(CheckValue(*FindParameter("simulation", "hash"), std::string("exakt")) ==
        "expected one of \"exact\", \"linear\", \"powers\", \"brute\", got \"exakt\" (did you mean `exact`?)");
}

TEST_CASE("An assignment sets what its path names") {
  Scene scene;
  scene.cloths.resize(2);
  scene.spheres.resize(1);

  auto paths = ApplyAssignment(scene, "cloth.ks=500");
  REQUIRE(paths);
  CHECK(*paths == std::vector<std::string>{"/cloth/0/ks", "/cloth/1/ks"});
  CHECK(scene.cloths[0].ks == 500);
  CHECK(scene.cloths[1].ks == 500);

  paths = ApplyAssignment(scene, "cloth.1.ks = 7e3");
  REQUIRE(paths);
  CHECK(*paths == std::vector<std::string>{"/cloth/1/ks"});
  CHECK(scene.cloths[0].ks == 500);
  CHECK(scene.cloths[1].ks == 7000);

  REQUIRE(ApplyAssignment(scene, "wind.velocity=[2, 0,-1.5]"));
  CHECK(scene.wind.velocity == Vec3{2, 0, -1.5});
  REQUIRE(ApplyAssignment(scene, "wind.velocity=[.5,-.25,+1.]"));  // as people type numbers
  CHECK(scene.wind.velocity == Vec3{0.5, -0.25, 1});
  for (const char* none :
       {"wind.drag=.", "wind.drag=-", "wind.drag=1..2", "wind.drag=", "wind.drag=+-1", "wind.drag=.e3"}) {
    CHECK_FALSE(ApplyAssignment(scene, none));
  }
  REQUIRE(ApplyAssignment(scene, "simulation.self_collision=false"));
  CHECK_FALSE(scene.simulation.selfCollision);
  REQUIRE(ApplyAssignment(scene, "simulation.hash=powers"));
  CHECK(scene.simulation.hash == HashFunction::Powers);
  REQUIRE(ApplyAssignment(scene, "simulation.plane_response=\"hold\""));
  CHECK(scene.simulation.planeResponse == PlaneResponse::Hold);
  REQUIRE(ApplyAssignment(scene, "cloth.0.pinned=[[0,0], [3, 4]]"));
  CHECK(scene.cloths[0].pinned == std::vector<GridPoint>{{0, 0}, {3, 4}});
  REQUIRE(ApplyAssignment(scene, "cloth.0.pinned=[7, [3,4]]"));
  CHECK(scene.cloths[0].pinned == std::vector<GridPoint>{{7, 0}, {3, 4}});
  REQUIRE(ApplyAssignment(scene, "cloth.0.pinned=[]"));
  CHECK(scene.cloths[0].pinned.empty());
  REQUIRE(ApplyAssignment(scene, "cloth.orientation=1"));
  CHECK(scene.cloths[0].orientation == Orientation::Vertical);
  REQUIRE(ApplyAssignment(scene, "look.shader=Phong"));
  CHECK(scene.look.shader == "Phong");
  paths = ApplyAssignment(scene, "camera.distance=3");
  REQUIRE(paths);
  CHECK(*paths == std::vector<std::string>{"/camera/distance"});
  CHECK_FALSE(scene.camera.automatic);
}

TEST_CASE("Every parameter can be assigned the text of any of its values") {
  for (const Parameter& p : Parameters()) {
    const std::string path = std::string(p.group) + "." + std::string(p.name);
    CAPTURE(path);
    Scene scene = OneOfEach();
    const Value value = Another(p, p.get(scene, 0));
    const auto result = ApplyAssignment(scene, path + "=" + FormatValue(value));
    REQUIRE_MESSAGE(result.ok(), Format(result.diagnostics()));
    CHECK(p.get(scene, 0) == value);
  }
}

TEST_CASE("A wrong assignment changes nothing and says why") {
  const struct {
    const char *assignment, *expected;
  } cases[] = {
      {"cloth.ks", "no '='"},
      {"", "no '='"},
      {"=5", "no group"},
      {"cloth=5", "expected GROUP.KEY=VALUE"},
      {"cloth.=5", "expected GROUP.KEY=VALUE"},
      {"cloht.ks=5", "did you mean `cloth`?"},
      {"ks=5", "did you mean cloth.ks?"},
      {"cloth.densty=5", "did you mean `density`?"},
      {"cloth.5.ks=5", "the scene has 1"},
      {"cloth.-1.ks=5", "expected the index"},
      {"cloth.x.ks=5", "expected the index"},
      {"cloth.0.0.ks=5", "expected the index"},
      {"cloth.1e300.ks=5", "expected the index"},
      {"wind.0.drag=5", "takes no index"},
      {"pin_motion.end=5", "has no pin_motion to set"},
      {"cloth.ks=5k", "expected a number >= 0 N/m, got \"5k\""},
      {"cloth.ks=", "expected a number"},
      {"cloth.ks=-1", "got -1"},
      {"cloth.ks=nan", "expected a number"},
      {"cloth.num_width_points=2.5", "expected a whole number"},
      {"wind.velocity=[1,2]", "expected an array of three numbers"},
      {"wind.velocity=[1,2,x]", "expected an array of three numbers"},
      {"wind.velocity=1,2,3", "expected an array of three numbers"},
      {"cloth.pinned=[0.5]", "expected an array of points [i, j]"},
      {"cloth.pinned=5", "expected an array of points [i, j]"},
      {"cloth.pinned=[[0,0]", "expected an array of points [i, j]"},
      {"cloth.pinned=[[0,0.5]]", "expected an array of points [i, j]"},
      {"cloth.pinned=[]]", "expected an array of points [i, j]"},
      {"simulation.self_collision=yes", "expected true or false"},
      {"simulation.hash=cubic", "expected one of"},
  };
  Scene scene = OneOfEach();
  scene.pinMotions.clear();
  for (const auto& c : cases) {
    CAPTURE(std::string(c.assignment));
    const auto result = ApplyAssignment(scene, c.assignment);
    REQUIRE_FALSE(result.ok());
    CHECK_MESSAGE(Mentions(result.diagnostics(), Severity::Error, c.expected), Format(result.diagnostics()));
  }
  for (const Parameter& p : Parameters()) {
    if (p.group != "pin_motion") CHECK(p.get(scene, 0) == p.get(OneOfEach(), 0));
  }
}

TEST_CASE("A scene of sensible settings has nothing wrong with it") {
  Scene scene = OneOfEach();
  scene.spheres[0].origin = {0, 1, 0};
  REQUIRE(CheckScene(scene).size() == 3);
  CHECK(Mentions(CheckScene(scene), Severity::Warning, "/patch/0: only the engine \"fabric\" heeds this"));
  CHECK(Mentions(CheckScene(scene), Severity::Warning, "/tether/0: only the engine \"fabric\" heeds this"));
  CHECK(Mentions(CheckScene(scene), Severity::Warning, "/collider/0: only the engine \"fabric\" heeds this"));
  scene.patches.clear();
  scene.colliders.clear();
  scene.colliderMotions.clear();
  scene.tethers.clear();
  CHECK(CheckScene(scene).empty());
}

TEST_CASE("Whatever is out of range is found, under its path") {
  for (const Parameter& p : Parameters()) {
    if (p.kind != ValueKind::Number && p.kind != ValueKind::Vector) continue;
    const std::string object = "/" + std::string(p.group) + (FindGroup(p.group)->isArray ? "/0" : "");
    const std::string path = object + "/" + std::string(p.name) + ": ";
    CAPTURE(path);
    Scene scene = OneOfEach();
    const double bad = std::nan("");
    if (p.kind == ValueKind::Number) p.set(scene, 0, bad);
    if (p.kind == ValueKind::Vector) p.set(scene, 0, Vec3{0, bad, 0});
    CHECK(Mentions(CheckScene(scene), Severity::Error, path));
  }
}

TEST_CASE("What concerns several values is found") {
  const auto check = [](void (*change)(Scene&), Severity severity, const char* expected) {
    CAPTURE(std::string(expected));
    Scene scene = OneOfEach();
    change(scene);
    const Diagnostics found = CheckScene(scene);
    CHECK_MESSAGE(Mentions(found, severity, expected), Format(found));
    CHECK(HasErrors(found) == (severity == Severity::Error));
  };
  constexpr Severity kError = Severity::Error, kWarning = Severity::Warning;
  check([](Scene& s) { s.cloths.clear(), s.pinMotions.clear(); }, kError, "/cloth: expected at least one cloth");
  check(
      [](Scene& s) {
        s.cloths[0].pinned.push_back({50, 0});
      },
      kError, "/cloth/0/pinned/2: expected a point of the grid, from [0, 0] to [49, 49], got [50, 0]");
  check([](Scene& s) { s.cloths[0].pinned.push_back({0, -1}); }, kError, "/cloth/0/pinned/2: ");
  check(
      [](Scene& s) {
        s.cloths[0].pinned.push_back({0, 0});
      },
      kWarning, "/cloth/0/pinned/2: [0, 0] is pinned already");
  check([](Scene& s) { s.planes[0].normal = {}; }, kError, "/plane/0/normal: expected a direction");
  check([](Scene& s) { s.planes[0].normal = {0, 1e-200, 0}; }, kError, "/plane/0/normal: expected a direction");
  check([](Scene& s) { s.pinMotions[0].cloth = 1; }, kError, "/pin_motion/0/cloth: expected the index of a cloth");
  check(
      [](Scene& s) {
        s.pinMotions[0].points = {{0, 0}, {1, 0}};
      },
      kError, "/pin_motion/0/points/1: expected a pinned point of the cloth, got [1, 0]");
  check([](Scene& s) { s.pinMotions[0].end = s.pinMotions[0].start = 2; }, kError,
        "/pin_motion/0/end: expected a time after");
  check([](Scene& s) { s.cloths[0].pinned.clear(); }, kError, "/pin_motion/0: there is no pin");
  check([](Scene& s) { s.pinMotions[0].angle = 90, s.pinMotions[0].axis = {}; }, kError,
        "/pin_motion/0/axis: expected a direction");
  check([](Scene& s) { s.colliders[0].shape = ColliderShape::Torus, s.colliders[0].tubeRadius = 0.2; }, kError,
        "/collider/0/tube_radius: expected less than the radius of its ring, 0.2 m, got 0.2 m");
  check(
      [](Scene& s) {
        s.colliders[0].size = {1, 0, 1};
      },
      kError, "/collider/0/size: expected an array of three numbers > 0");
  check([](Scene& s) { s.colliders[0].meshScale = 0; }, kError, "/collider/0/mesh_scale: expected a number > 0");
  check([](Scene& s) { s.colliderMotions[0].collider = 3; }, kError,
        "/collider_motion/0/collider: expected the index of a collider, 0 as there is only one, got 3");
  check([](Scene& s) { s.colliders.clear(); }, kError,
        "/collider_motion/0/collider: there is no collider that could move");
  check([](Scene& s) { s.colliderMotions[0].end = s.colliderMotions[0].start = 2; }, kError,
        "/collider_motion/0/end: expected a time after the start at 2 s, got 2 s");
  check(
      [](Scene& s) {
        s.colliderMotions[0].angle = 90, s.colliderMotions[0].axis = {0, 1e-20, 0};
      },
      kError, "/collider_motion/0/axis: expected a direction, such as [0, 1, 0]");
  check([](Scene& s) { s.cloths[0].width = 1e-12; }, kError, "/cloth/0/width: expected a spacing");
  check([](Scene& s) { s.cloths[0].numWidthPoints = s.cloths[0].numHeightPoints = 1000000; }, kError,
        "got 1000000000000, of which this cloth has 1000000 x 1000000");
  check([](Scene& s) { s.cloths[0].density = 0; }, kWarning, "/cloth/0/density: the cloth has no mass");
  check([](Scene& s) { s.cloths[0].ks = 2.2e5; }, kWarning, "/cloth/0/ks: 220000 N/m is above the stable limit");
  check([](Scene& s) { s.cloths[0].thickness = 0.011; }, kWarning, "/cloth/0/thickness: ");
  for (const char* name : {"", "../Phong", "a/b", "a\\b", ".hidden"}) {
    Scene scene = OneOfEach();
    scene.look.shader = name;
    CHECK(Mentions(CheckScene(scene), kError, "/look/shader: "));
  }
}

TEST_CASE("Many cloths that fit one by one but not together are refused") {
  Scene scene;
  scene.cloths.resize(1000);
  for (ClothSettings& cloth : scene.cloths) cloth.numWidthPoints = cloth.numHeightPoints = 1000;
  CHECK(Mentions(CheckScene(scene), Severity::Error, "points in all cloths together"));
}

TEST_CASE("The stable limit is the one of the course, and its advice removes the warning") {
  Scene scene;
  scene.cloths.resize(1);
  ClothSettings& cloth = scene.cloths[0];
  CHECK(LargestStableKs(cloth, scene.TimeStep()) == doctest::Approx(2.187e5));
  CHECK(PointMass(cloth) == doctest::Approx(0.06));
  cloth.density = 10;
  cloth.ks = 1e5;
  const int steps = SmallestStableStepsPerFrame(cloth, scene.simulation.framesPerSecond);
  REQUIRE(Mentions(CheckScene(scene), Severity::Warning, "simulation.steps_per_frame to " + std::to_string(steps)));

  scene.simulation.stepsPerFrame = steps;
  CHECK(CheckScene(scene).empty());
  scene.simulation.stepsPerFrame = steps - 1;
  CHECK_FALSE(CheckScene(scene).empty());

  scene.simulation.stepsPerFrame = 30;
  cloth.ks = std::nextafter(RoundDown(LargestStableKs(cloth, scene.TimeStep()), 4), 0);  // "below" that
  CHECK(CheckScene(scene).empty());

  cloth.density = 0;
  CHECK(std::isinf(LargestStableKs(cloth, scene.TimeStep())));
  CHECK(SmallestStableStepsPerFrame(cloth, 90) == 1);
}

TEST_CASE("Twice the largest sensible thickness is the smallest spacing") {
  ClothSettings cloth;
  CHECK(2 * LargestSensibleThickness(cloth) == doctest::Approx(1.0 / 49));
  cloth.numHeightPoints = 100;
  CHECK(2 * LargestSensibleThickness(cloth) == doctest::Approx(1.0 / 99));

  Scene scene;
  scene.cloths.push_back(cloth);
  CHECK_FALSE(CheckScene(scene).empty());
  scene.simulation.selfCollision = false;
  CHECK(CheckScene(scene).empty());
  scene.simulation.selfCollision = true;
  scene.cloths[0].thickness = RoundDown(LargestSensibleThickness(cloth), 4);
  CHECK(CheckScene(scene).empty());
}

}  // namespace
}  // namespace percale
