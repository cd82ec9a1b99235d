#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "apps/cli/verify_cases.h"
#include "apps/cli/verify_laws.h"
#include "apps/cli/verify_specimen.h"
#include "core/text.h"
#include "math/splitmix64.h"

namespace percale::cli {
namespace {

/// A metre of cotton, free.
ClothSettings Cotton(int elements) {
  ClothSettings cloth = PlainSheet(1, 1, elements, elements, 0.15, 261, 0.243, 4e-5);
  return cloth;
}

/// A rotation by 1 radian about an axis askew.
Vec3 Turned(const Vec3& x) {
  const Vec3 axis = Vec3{2, 3, 6} / 7;
  const double c = std::cos(1.0), s = std::sin(1.0);
  return x * c + Cross(axis, x) * s + axis * (Dot(axis, x) * (1 - c));
}

std::vector<Vec3> Copy(std::span<const Vec3> x) {
  return {x.begin(), x.end()};
}

double Farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) most = std::max(most, Length(a[v] - b[v]));
  return most;
}

}  // namespace

CaseResult VerifyFreeMotion(const Effort& effort) {
  const int elements = Elements(10 * effort.mesh, 2), steps = 100;
  constexpr int kRate = 100;
  CaseResult result;
  {
    Scene scene = EmptyScene(kRate);
    scene.cloths.push_back(Cotton(elements));
    scene.simulation.gravity = {0, -kGravity, 0};
    World world(scene, {.threads = 1});
    for (int k = 0; k < steps; ++k) world.Step();
    const double fall = 0.5 * kGravity * steps * (steps + 1) / (kRate * kRate);
    double off = 0;
    for (std::size_t v = 0; v < world.Cloth(0).positions().size(); ++v) {
      off = std::max(off, Length(world.Cloth(0).positions()[v] - world.Cloth(0).rest()[v] + Vec3{0, fall, 0}));
    }
    result.readings.push_back(
        Absolute("free fall of 1 s: farthest vertex from ½ g h² n (n + 1), over that", off / fall, 0, 1e-6));
  }
  {
    Scene scene = EmptyScene(kRate);
    scene.cloths.push_back(Cotton(elements));
    World world(scene, {.threads = 1});
    const std::vector<Vec3> rest = Copy(world.Cloth(0).rest());
    const Vec3 velocity{1, 2, -0.5};
    Put(
        world, [&](int v) { return rest[std::size_t(v)]; }, [&](int) { return velocity; });
    for (int k = 0; k < steps; ++k) world.Step();
    double off = 0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
      off = std::max(off, Length(world.Cloth(0).positions()[v] - rest[v] - velocity * (double(steps) / kRate)));
    }
    result.readings.push_back(
        Absolute("uniform motion for 1 s: farthest vertex, over the way", off / Length(velocity), 0, 1e-6));
  }
  {
    Scene scene = EmptyScene(kRate);
    scene.cloths.push_back(Cotton(elements));
    World world(scene, {.threads = 1});
    std::vector<Vec3> turned;
    for (const Vec3& x : world.Cloth(0).rest()) turned.push_back(Turned(x));
    Put(
        world, [&](int v) { return turned[std::size_t(v)]; }, [](int) { return Vec3{}; });
    for (int k = 0; k < steps; ++k) world.Step();
    result.readings.push_back(Absolute("turned sheet at rest for 1 s: farthest vertex, over the side",
                                       Farthest(world.Cloth(0).positions(), turned), 0, 1e-6));
  }
  {
    // A sheet that falls from two corners, and the same seen from a turned frame.
    std::array<std::vector<Vec3>, 2> ends;
    for (const bool turn : {false, true}) {
      Scene scene = EmptyScene(kRate);
      scene.cloths.push_back(Cotton(elements));
      scene.cloths[0].pinned = {{0, 0}, {elements, 0}};
      const Vec3 gravity{0, -kGravity, 0};
      scene.simulation.gravity = turn ? Turned(gravity) : gravity;
      World world(scene, {.threads = 1});
      const std::vector<Vec3> rest = Copy(world.Cloth(0).rest());
      const auto place = [&](int v) { return turn ? Turned(rest[std::size_t(v)]) : rest[std::size_t(v)]; };
      Put(world, place, [](int) { return Vec3{}; });
      for (int k = 0; k < steps / 4; ++k) world.Step();
      for (const Vec3& x : world.Cloth(0).positions()) ends[turn].push_back(x);
    }
    for (Vec3& x : ends[0]) x = Turned(x);
    result.readings.push_back(Absolute("a fall seen from a turned frame: farthest vertex, over the side",
                                       Farthest(ends[0], ends[1]), 0, 1e-6));
  }
  return result;
}

CaseResult VerifyMomentum(const Effort& effort) {
  const int elements = Elements(12 * effort.mesh, 2);
  constexpr int kRate = 100, kSteps = 50;
  Scene scene = EmptyScene(kRate);
  scene.cloths.push_back(Cotton(elements));
  World world(scene, {.threads = 1});
  const std::vector<Vec3> rest = Copy(world.Cloth(0).rest());
  const std::vector<double> mass = Masses(world.Cloth(0), scene.cloths[0]);
  SplitMix64 random(11);
  std::vector<Vec3> velocity;
  for (const Vec3& x : rest) {
    const Vec3 noise{random.NextUnit() - 0.5, random.NextUnit() - 0.5, random.NextUnit() - 0.5};
    velocity.push_back(noise + Cross({1, 2, 3}, x) + Vec3{0.3, 0.2, 0.1});
  }
  Put(
      world, [&](int v) { return rest[std::size_t(v)]; }, [&](int v) { return velocity[std::size_t(v)]; });
  const auto linear = [&] {
    Vec3 sum;
    for (std::size_t v = 0; v < mass.size(); ++v) sum += world.Cloth(0).velocities()[v] * mass[v];
    return sum;
  };
  const auto moment = [&](std::span<const Vec3> x, std::span<const Vec3> v) {
    Vec3 sum;
    for (std::size_t k = 0; k < mass.size(); ++k) sum += Cross(x[k], v[k]) * mass[k];
    return sum;
  };
  const Vec3 before = linear(), turnBefore = moment(world.Cloth(0).positions(), world.Cloth(0).velocities());
  double drift = 0, torque = 0;
  for (int k = 0; k < kSteps; ++k) {
    const std::vector<Vec3> old = Copy(world.Cloth(0).velocities());
    world.Step();
    drift = std::max(drift, Length(linear() - before) / Length(before));
    const std::span<const Vec3> x = world.Cloth(0).positions();
    torque = std::max(torque, Length(moment(x, world.Cloth(0).velocities()) - moment(x, old)) / Length(turnBefore));
  }
  const Vec3 turnAfter = moment(world.Cloth(0).positions(), world.Cloth(0).velocities());
  CaseResult result;
  result.readings.push_back(Absolute("linear momentum over 50 steps: greatest drift, over all", drift, 0, 1e-6));
  result.readings.push_back(Absolute("angular impulse of the inner forces in a step, over all", torque, 0, 1e-6));
  result.note = "Backward Euler itself loses angular momentum, h Σ m v' × v per step: here " +
                FormatNumber(std::round(1000 * (1 - Length(turnAfter) / Length(turnBefore))) / 10) +
                " % in half a second. The inner forces have no part in that.";
  return result;
}

CaseResult VerifyPendulum(const Effort& effort) {
  // All of its mass is at the free end of a strip of one element that does not give.
  constexpr double kLength = 10, kDensity = 1;
  const double frequency = std::sqrt(kGravity / kLength);  // small swings [1/s]
  const int rate = Elements(1000 * frequency * effort.step);
  CaseResult result;
  for (const double degrees : {45.0, 90.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    Scene scene = EmptyScene(rate);
    scene.cloths.push_back(PlainSheet(kLength, 1, 1, 1, kDensity, 1e5 * kDensity * kGravity * kLength, 0, 0));
    PinColumn(scene.cloths[0], 0);
    scene.simulation.gravity = {0, -kGravity, 0};
    World world(scene, {.threads = 1});
    const std::vector<Vec3> rest = Copy(world.Cloth(0).rest());
    const auto place = [&](int v) {
      const Vec3& x = rest[std::size_t(v)];
      return Vec3{x.x * std::sin(angle), -x.x * std::cos(angle), x.z};
    };
    Put(world, place, [](int) { return Vec3{}; });
    double before = place(1).x, quarter = NAN;
    for (int k = 0; k < 4 * rate / frequency && !(quarter > 0); ++k) {
      if (world.Step().divergence) break;
      const double now = world.Cloth(0).positions()[1].x;
      if (now <= 0) quarter = (k + before / (before - now)) / rate;
      before = now;
    }
    result.readings.push_back(Relative("T/T0 at " + FormatNumber(degrees) + "°",
                                       4 * quarter * frequency / (2 * std::numbers::pi), PendulumPeriod(angle), 0.005));
  }
  return result;
}

CaseResult VerifyDecay(const Effort&) {
  // A mass on a spring: one triangle, held by its base. A third of it is at the apex, and all of it stretches alike:
  // ω² = K A/l² / (ρ A/3).
  constexpr double kLength = 1, kDensity = 1, kStiffness = 50, kOff = 3e-4;
  RestMesh mesh;
  mesh.positions = {{0, 0, 0.5}, {kLength, 0, 0}, {0, 0, -0.5}};
  mesh.triangles = {{0, 1, 2}};
  mesh.material = {{0, -0.5}, {kLength, 0}, {0, 0.5}};
  const double frequency = std::sqrt(3 * kStiffness / kDensity) / kLength;  // [1/s]
  CaseResult result;
  for (const double nearly : {0.1, 1.0}) {
    const int rate = Elements(frequency / nearly);
    const double perStep = frequency / rate;
    Scene scene = EmptyScene(rate);
    scene.cloths.push_back(PlainSheet(1, 1, 1, 1, kDensity, kStiffness, 0, 0));
    MeshRun run(scene, mesh, {0, 2});
    std::vector<Vec3> start = mesh.positions;
    start[1].x += kOff;
    run.Put(start);
    double a[4];
    for (double& off : a) {
      run.Step();
      off = run.positions()[1].x - kLength;
    }
    // Each is p times the last less q times the last but one; q is the square of what a step leaves.
    const double square = (a[2] * a[2] - a[1] * a[3]) / (a[1] * a[1] - a[0] * a[2]);
    result.readings.push_back(
        Relative("amplitude after a step over before, ωh = " + FormatNumber(RoundDown(perStep, 4)), std::sqrt(square),
                 1 / std::sqrt(1 + perStep * perStep), 0.01));
  }
  return result;
}

CaseResult VerifyOrder(const Effort& effort) {
  // A soft strip that hangs at rest and is given a swing.
  constexpr double kTime = 0.3, kTurn = 5;  // s, 1/s
  std::vector<std::vector<Vec3>> ends;
  const int first = Elements(200 * effort.step);
  for (const int rate : {first, 2 * first, 4 * first}) {
    Scene scene = EmptyScene();
    scene.cloths.push_back(PlainSheet(0.5, 0.1, Elements(10 * effort.mesh, 2), 2, 0.15, 50, 0.243, 4e-5));
    PinColumn(scene.cloths[0], 0);
    scene.simulation.gravity = {kGravity, 0, 0};
    World world(scene, {.threads = 1});
    Settle(world);
    scene.simulation.framesPerSecond = rate;
    world.Apply(scene);
    const std::vector<Vec3> start = Copy(world.Cloth(0).positions());
    Put(
        world, [&](int v) { return start[std::size_t(v)]; },
        [&](int v) {
          return Vec3{0, kTurn * start[std::size_t(v)].x, 0};
        });
    for (int k = 0; k < kTime * rate - 0.5; ++k) world.Step();
    ends.push_back(Copy(world.Cloth(0).positions()));
  }
  const auto distance = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) sum += Dot(a[v] - b[v], a[v] - b[v]);
    return std::sqrt(sum / double(a.size()));
  };
  CaseResult result;
  result.readings.push_back(Absolute("order of backward Euler in h",
                                     std::log2(distance(ends[0], ends[1]) / distance(ends[1], ends[2])), 1, 0.15));
  return result;
}

}  // namespace percale::cli
