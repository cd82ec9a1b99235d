// The spring engine against closed forms: of the integrator where there is one, else of mechanics.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/springs/scenes.h"
#include "world/limits.h"

using namespace percale;
using namespace percale::test;

namespace {

/// Only structural springs, no contacts, no damping, one step per frame so that each step is seen.
Scene BareScene(int numWidth, int numHeight) {
  Scene scene;
  ClothSettings cloth;
  cloth.numWidthPoints = numWidth;
  cloth.numHeightPoints = numHeight;
  cloth.width = numWidth - 1;
  cloth.height = numHeight - 1;
  cloth.damping = 0;
  cloth.density = 100;
  cloth.ks = 5000;
  cloth.enableShearing = cloth.enableBending = false;
  scene.cloths.push_back(cloth);
  scene.simulation.framesPerSecond = 2700;
  scene.simulation.stepsPerFrame = 1;
  scene.simulation.selfCollision = false;
  return scene;
}

Vec3 Momentum(const World& world, double mass) {
  Vec3 sum;
  for (const Vec3& v : world.Cloth(0).velocities()) sum += mass * v;
  return sum;
}

/// Sum of |m v|, against which a drift of momentum is measured.
double MomentumScale(const World& world, double mass) {
  double sum = 0;
  for (const Vec3& v : world.Cloth(0).velocities()) sum += mass * Length(v);
  return sum;
}

/// Sum of m x_previous x v, which Verlet keeps to rounding where all forces are central.
Vec3 AngularMomentum(const World& world, double mass) {
  Vec3 sum;
  const ClothView cloth = world.Cloth(0);
  for (std::size_t v = 0; v < cloth.positions().size(); ++v) {
    sum += mass * Cross(cloth.positions()[v], cloth.velocities()[v]);
  }
  return sum;
}

}  // namespace

TEST_CASE("free fall is Verlet's to rounding: y = y0 - g dt^2 n (n + 1) / 2") {
  Scene scene = SmallScene(6, 5);
  scene.cloths[0].damping = 0;
  scene.simulation.gravity = {0.5, -9.8, 0.25};
  scene.simulation.framesPerSecond = 100;
  scene.simulation.stepsPerFrame = 10;
  World world(scene);
  const std::vector<Vec3> start(world.Cloth(0).positions().begin(), world.Cloth(0).positions().end());
  const double dt = 1e-3;
  for (int frame = 1; frame <= 100; ++frame) {
    world.Step();
    const double n = 10.0 * frame;
    const Vec3 way = scene.simulation.gravity * (dt * dt * n * (n + 1) / 2);
    for (std::size_t v = 0; v < start.size(); ++v) {
      REQUIRE(Length(world.Cloth(0).positions()[v] - start[v] - way) < 1e-10);
    }
  }
}

TEST_CASE("damping leaves (1 - d) of the velocity in a step: a fall approaches g dt (1 - d) / d") {
  Scene scene = SmallScene(3, 3);
  scene.cloths[0].damping = 2;
  World world(scene);
  Run(world, 60);
  const double dt = scene.TimeStep(), keep = 0.98, n = 60 * 30;
  // v_n = g dt (1 + keep + ... + keep^(n-1))
  const double speed = 9.8 * dt * (1 - std::pow(keep, n)) / (1 - keep);
  for (const Vec3& v : world.Cloth(0).velocities()) CHECK(v.y == doctest::Approx(-speed).epsilon(1e-6));

  scene.cloths[0].damping = 100;
  World stiff(scene);
  Run(stiff, 60);
  for (const Vec3& v : stiff.Cloth(0).velocities()) CHECK(v.y == doctest::Approx(-9.8 * dt).epsilon(1e-6));
}

TEST_CASE("one mass on one spring follows the closed form of Verlet, in period and in energy") {
  Scene scene = BareScene(2, 2);
  scene.cloths[0].pinned = {{0, 0}, {1, 0}};
  const double g = 0.5;
  scene.simulation.gravity = {0, 0, g};  // along the springs
  World world(scene);
  const double m = PointMass(scene.cloths[0]), k = scene.cloths[0].ks, dt = scene.TimeStep();
  const double rest = g * m / k;  // where gravity and spring balance
  // Verlet turns cos(w t) into cos(theta n), and a start with x_-1 = x_0 lies half a step off.
  const double theta = std::acos(1 - k / m * dt * dt / 2);
  const auto expected = [&](int n) { return rest - rest * std::cos((n + 0.5) * theta) / std::cos(theta / 2); };
  // Discrete energy that Verlet keeps: m v^2 / 2 + k u_n u_(n-1) / 2 - m g (u_n + u_(n-1)) / 2.
  double before = 0;
  for (int n = 1; n <= 5000; ++n) {
    const StepReport& report = world.Step();
    REQUIRE(report.limitedSprings == 0);
    for (const std::size_t v : {std::size_t{2}, std::size_t{3}}) {
      const Vec3 x = world.Cloth(0).positions()[v];
      REQUIRE(std::abs(x.z - 1 - expected(n)) < 1e-9);
      REQUIRE(x.y == 1);
    }
    const double u = world.Cloth(0).positions()[2].z - 1;
    const double kinetic = report.kineticEnergy / 2;  // two masses
    const double energy = kinetic + k * u * before / 2 - m * g * (u + before) / 2;
    REQUIRE(std::abs(energy) < 1e-9 * m * g * rest);
    before = u;
  }
  // And that closed form has the period of mechanics, 2 pi sqrt(m / k), to second order in dt.
  const double period = 2 * std::numbers::pi / theta * dt, exact = 2 * std::numbers::pi * std::sqrt(m / k);
  CHECK(period == doctest::Approx(exact).epsilon(k / m * dt * dt));
}

TEST_CASE("two masses on a chain swing with their two modes") {
  Scene scene = BareScene(2, 3);
  scene.cloths[0].pinned = {{0, 0}, {1, 0}};
  const double g = 0.5;
  scene.simulation.gravity = {0, 0, g};
  World world(scene);
  const double m = PointMass(scene.cloths[0]), k = scene.cloths[0].ks, dt = scene.TimeStep();
  // Stiffness matrix k (2 -1; -1 1): eigenvalues k (3 -+ sqrt 5) / 2, eigenvectors (1, phi), (phi, -1).
  const double phi = (1 + std::sqrt(5.0)) / 2;
  const double lambda[2] = {(3 - std::sqrt(5.0)) / 2, (3 + std::sqrt(5.0)) / 2};
  const double shape[2][2] = {{1, phi}, {phi, -1}};
  const double rest[2] = {2 * m * g / k, 3 * m * g / k};
  double theta[2], amplitude[2];
  for (int mode = 0; mode < 2; ++mode) {
    theta[mode] = std::acos(1 - lambda[mode] * k / m * dt * dt / 2);
    amplitude[mode] = (rest[0] * shape[mode][0] + rest[1] * shape[mode][1]) / (1 + phi * phi);
  }
  for (int n = 1; n <= 4000; ++n) {
    REQUIRE(world.Step().limitedSprings == 0);
    for (int mass = 0; mass < 2; ++mass) {
      double u = rest[mass];
      for (int mode = 0; mode < 2; ++mode) {
        u -= amplitude[mode] * shape[mode][mass] * std::cos((n + 0.5) * theta[mode]) / std::cos(theta[mode] / 2);
      }
      const double z = world.Cloth(0).positions()[static_cast<std::size_t>(2 + 2 * mass)].z;
      REQUIRE(std::abs(z - 1 - mass - u) < 1e-9);
    }
  }
}

TEST_CASE("bending springs have a fifth of the stiffness") {
  Scene scene = BareScene(2, 3);
  scene.cloths[0].pinned = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  scene.cloths[0].enableStructural = false;
  scene.cloths[0].enableBending = true;
  scene.cloths[0].damping = 0.5;
  scene.simulation.gravity = {0, 0, 0.5};
  World world(scene);
  Run(world, 20000);
  const double m = PointMass(scene.cloths[0]);
  for (const std::size_t v : {std::size_t{4}, std::size_t{5}}) {
    CHECK(world.Cloth(0).positions()[v].z - 2 == doctest::Approx(m * 0.5 / (0.2 * 5000)).epsilon(1e-6));
  }
}

TEST_CASE("without gravity and pins momentum is conserved, through the strain limit as well") {
  // A sheet falls onto a sphere; then sphere, gravity and contacts are taken away and it flies on.
  Scene scene = CourseScene("sphere", 24);
  scene.cloths[0].damping = 0;
  World world(scene);
  Run(world, 55);
  scene.spheres.clear();
  scene.simulation.gravity = {0, 0, 0};
  scene.simulation.selfCollision = false;
  REQUIRE(world.Apply(scene));
  world.Step();
  const double mass = PointMass(scene.cloths[0]);
  const Vec3 start = Momentum(world, mass);
  const double scale = MomentumScale(world, mass);
  REQUIRE(scale > 1);
  std::int64_t limited = 0;
  for (int frame = 0; frame < 150; ++frame) {
    limited += world.Step().limitedSprings;
    REQUIRE(Length(Momentum(world, mass) - start) < 1e-9 * scale);
  }
  CHECK(limited > 0);
}

TEST_CASE("forces of springs are central: while none is limited, angular momentum is conserved") {
  // The mildest of pushes: points a little too near each other part in the first steps.
  Scene scene = SmallScene(8, 8);
  scene.simulation.gravity = {0, 0, 0};
  scene.cloths[0].damping = 0;
  scene.cloths[0].orientation = Orientation::Vertical;
  scene.cloths[0].thickness = 0.05001;
  scene.simulation.stepsPerFrame = 100;
  World world(scene);
  world.Step();
  scene.simulation.selfCollision = false;
  REQUIRE(world.Apply(scene));
  world.Step();
  const double mass = PointMass(scene.cloths[0]);
  const Vec3 linear = Momentum(world, mass), angular = AngularMomentum(world, mass);
  const double scale = MomentumScale(world, mass);
  REQUIRE(scale > 1e-4);
  for (int frame = 0; frame < 100; ++frame) {
    REQUIRE(world.Step().limitedSprings == 0);
    REQUIRE(Length(Momentum(world, mass) - linear) < 1e-9 * scale);
    REQUIRE(Length(AngularMomentum(world, mass) - angular) < 1e-9 * scale);
  }
}

TEST_CASE("without any cause a cloth does not stir") {
  for (const Orientation orientation : {Orientation::Horizontal, Orientation::Vertical}) {
    Scene scene = SmallScene(9, 7);
    scene.simulation.gravity = {0, 0, 0};
    scene.cloths[0].orientation = orientation;
    World world(scene);
    const std::uint64_t start = world.StateHash();
    Run(world, 50);
    CHECK(world.StateHash() == start);
  }
}

TEST_CASE("where a cloth is makes no difference to its motion") {
  Scene scene = CourseScene("pinned2", 12);
  scene.simulation.selfCollision = false;  // the boxes of the spatial map stand still
  World here(scene);
  scene.cloths[0].origin = {-3, 5, 2};
  World there(scene);
  Run(here, 60);
  Run(there, 60);
  for (std::size_t v = 0; v < here.Cloth(0).positions().size(); ++v) {
    CHECK(Length(there.Cloth(0).positions()[v] - here.Cloth(0).positions()[v] - Vec3{-3, 5, 2}) < 1e-9);
  }
}

TEST_CASE("a chain of one spring is never longer than 1.1 of its length") {
  Scene scene = BareScene(2, 2);
  scene.cloths[0].pinned = {{0, 0}, {1, 0}};
  for (const double g : {20.0, 100.0, 10000.0}) {
    CAPTURE(g);
    scene.simulation.gravity = {0, 0, g};
    World world(scene);
    std::int64_t limited = 0;
    for (int step = 0; step < 5000; ++step) {
      const StepReport& report = world.Step();
      REQUIRE(report.greatestStretch <= 1.1 * (1 + 1e-12));
      limited += report.limitedSprings;
    }
    CHECK(limited > 0);
  }
}

TEST_CASE("in a long chain only what one sweep cannot mend remains above 1.1") {
  // In a sweep from the top, each spring is mended and then pulled again by half the excess of the
  // next. So no spring stays longer than its limit by more than half of what the one after it had,
  // which was at most half its own step's growth plus half of what those above handed down.
  Scene scene = BareScene(2, 12);
  scene.cloths[0].pinned = {{0, 0}, {1, 0}};
  scene.cloths[0].ks = 0;  // nothing but the limit holds it
  scene.cloths[0].damping = 1;
  scene.simulation.gravity = {0, 0, 50};
  World world(scene);
  std::int64_t limited = 0;
  double greatest = 0;
  for (int step = 0; step < 8000; ++step) {
    const StepReport& report = world.Step();
    limited += report.limitedSprings;
    greatest = std::max(greatest, report.greatestStretch);
    // The last spring of the sweep is followed by none, so it is mended for good.
    const auto x = world.Cloth(0).positions();
    REQUIRE(Length(x[23] - x[19]) <= 2 * 1.1 * (1 + 1e-12));
  }
  CHECK(limited > 0);
  CHECK(greatest > 1.1);
  CHECK(greatest < 1.2);
}

TEST_CASE("wind blows a sheet along, and not beyond its own speed") {
  Scene scene = SmallScene(6, 6);
  scene.simulation.gravity = {0, 0, 0};
  scene.simulation.selfCollision = false;
  scene.cloths[0].damping = 0;
  scene.wind = {{3, 4, 3}, 200, 0, 1};  // across the sheet with 4 m/s
  World world(scene);
  const double area = 0.25;
  // In the first step every point feels drag * its area * 4 m/s, and the areas add up to the sheet.
  double force = 0;
  Scene gentle = scene;
  gentle.simulation.framesPerSecond = 2700;
  gentle.simulation.stepsPerFrame = 1;
  World once(gentle);
  once.Step();
  for (const Vec3& v : once.Cloth(0).velocities()) {
    CHECK(v.x == 0);
    force += PointMass(scene.cloths[0]) * v.y / gentle.TimeStep();
  }
  CHECK(force == doctest::Approx(200 * 4 * area).epsilon(1e-9));
  // Its rim, where a point has less area, lags behind, so the sheet bends and turns; on the whole it
  // is carried along, never faster than the air.
  Run(world, 100);
  const Vec3 momentum = Momentum(world, PointMass(scene.cloths[0]));
  const double speed = momentum.y / (36 * PointMass(scene.cloths[0]));
  CHECK(speed > 1);
  CHECK(speed < 4);

  scene.wind.drag = 0;
  World still(scene);
  Run(still, 10);
  CHECK(still.report().kineticEnergy == 0);
}
