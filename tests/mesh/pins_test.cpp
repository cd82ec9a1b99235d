#include "mesh/pins.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "mesh/cloth_model.h"

using namespace percale;

namespace {

/// A sheet of 4 x 3 points whose first and last columns are pinned.
struct Sheet {
  Scene scene;
  std::vector<Vec3> start;
  Pins pins;

  Sheet() {
    ClothSettings& cloth = scene.cloths.emplace_back();
    cloth.numWidthPoints = 4;
    cloth.numHeightPoints = 3;
    for (int j = 0; j < 3; ++j) cloth.pinned.insert(cloth.pinned.end(), {{0, j}, {3, j}});
    start = MakeGrid(cloth).start;
  }
  void Update(double time) {
    pins.Update(scene, std::vector<int>{0}, time, [&](int p) { return start[static_cast<std::size_t>(p)]; });
  }
  const Vec3& StartOf(const Pin& pin) const { return start[static_cast<std::size_t>(pin.point)]; }
};

PinMotion Turn(double angle) {
  PinMotion motion;
  motion.axis = {2, 0, 0};
  motion.angle = angle;
  motion.centre = {0, 1, 0.5};
  return motion;
}

}  // namespace

TEST_CASE("two rims are turned against each other by many turns, each about the axis") {
  Sheet sheet;
  PinMotion left = Turn(360 * 20), right = Turn(-360 * 20.25);
  left.points = {{0, 0}, {0, 1}, {0, 2}};
  right.points = {{3, 0}, {3, 1}, {3, 2}};
  left.end = right.end = 10;
  sheet.scene.pinMotions = {left, right};
  sheet.Update(0);
  const auto arm = [&](const Vec3& p) { return p - Vec3{p.x, 1, 0.5}; };
  for (const double time : {0.0, 1.3, 5.0, 9.9}) {
    REQUIRE(sheet.pins.MoveTo(time));
    for (const Pin& pin : sheet.pins.All()) {
      CHECK(std::abs(pin.target.x - sheet.StartOf(pin).x) < 1e-14);
      CHECK(Length(arm(pin.target)) == doctest::Approx(Length(arm(sheet.StartOf(pin)))).epsilon(1e-14));
    }
  }
  sheet.pins.MoveTo(10);
  for (const Pin& pin : sheet.pins.All()) {
    const Vec3 start = sheet.StartOf(pin);
    if (start.x < 0.5) {
      CHECK(Length(pin.target - start) < 1e-14);
    } else {
      // A quarter turn clockwise seen from the tip of x: z goes to y.
      CHECK(Length(arm(pin.target) - Vec3{0, arm(start).z, -arm(start).y}) < 1e-14);
    }
  }
}

TEST_CASE("a motion that does not turn adds its share of the way, to the bit") {
  Sheet sheet;
  PinMotion smooth, steady;
  smooth.displacement = {0.1, 0.2, -0.3};
  steady.displacement = {0, 1, 0};
  steady.end = 2;
  steady.steady = true;
  sheet.scene.pinMotions = {smooth, steady};
  sheet.Update(0);
  for (const double time : {0.3, 0.7, 1.5, 3.0}) {
    sheet.pins.MoveTo(time);
    const double s = std::min(time, 1.0), share = s * s * (3 - 2 * s);
    Vec3 way;
    way += smooth.displacement * share;
    way += steady.displacement * std::min(time / 2, 1.0);
    for (const Pin& pin : sheet.pins.All()) CHECK(pin.target == sheet.StartOf(pin) + way);
  }
}

TEST_CASE("displacements add up to turns and carry their centre along") {
  Sheet sheet;
  PinMotion way;
  way.displacement = {0, 3, 0};
  for (const bool turnFirst : {false, true}) {
    sheet.scene.pinMotions = turnFirst ? std::vector{Turn(90), way} : std::vector{way, Turn(90)};
    sheet.pins = {};
    sheet.Update(0);
    sheet.pins.MoveTo(2);
    for (const Pin& pin : sheet.pins.All()) {
      const Vec3 start = sheet.StartOf(pin);
      CHECK(Length(pin.target - Vec3{start.x, 4 - (start.z - 0.5), 0.5 + (start.y - 1)}) < 1e-15);
    }
  }
}

// Done of a smooth motion at 0.4 of its time.
constexpr double kShare = 0.4 * 0.4 * (3 - 2 * 0.4);
constexpr double kDegree = 3.14159265358979323846 / 180;

TEST_CASE("what is pinned or pulled amid a turn is where it was, and goes on with it") {
  Sheet sheet;
  sheet.scene.pinMotions = {Turn(300)};
  sheet.Update(0.4);  // at rest so far: pinned at this time
  for (const Pin& pin : sheet.pins.All()) {
    CHECK(pin.target == sheet.StartOf(pin));
    const bool onAxis = pin.target == Vec3{pin.target.x, 1, 0.5};
    CHECK(Length(pin.anchor - pin.target) == doctest::Approx(onAxis ? 0 : 2 * 0.5 * std::sin(150 * kShare * kDegree)));
  }
  sheet.pins.MoveTo(0.4);
  for (const Pin& pin : sheet.pins.All()) CHECK(Length(pin.target - sheet.StartOf(pin)) < 1e-15);

  const Vec3 pulled = sheet.pins.All()[2].target + Vec3{0.1, -0.2, 0.3};
  sheet.pins.Shift(2, {0.1, -0.2, 0.3});
  CHECK(sheet.pins.All()[2].target == pulled);
  sheet.pins.MoveTo(0.4);
  CHECK(Length(sheet.pins.All()[2].target - pulled) < 1e-15);

  // The same from the anchors alone, which is what a state keeps.
  std::vector<Vec3> anchors;
  sheet.pins.ReadAnchors(0, anchors);
  std::vector<Vec3> targets;
  for (const Pin& pin : sheet.pins.All()) targets.push_back(pin.target);
  Sheet other;
  other.scene = sheet.scene;
  other.Update(0);
  for (std::size_t k = 0; k < targets.size(); ++k)
    other.start[static_cast<std::size_t>(other.pins.All()[k].point)] = targets[k];
  other.pins.WriteAnchors(0, anchors, 0.4, [&](int p) { return other.start[static_cast<std::size_t>(p)]; });
  for (Sheet* s : {&sheet, &other}) s->pins.Shift(1, {0, 0, 0.5});
  for (Sheet* s : {&sheet, &other}) s->pins.MoveTo(0.9);
  for (std::size_t k = 0; k < targets.size(); ++k) CHECK(sheet.pins.All()[k].target == other.pins.All()[k].target);
}
