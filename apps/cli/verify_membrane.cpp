#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "apps/cli/verify_cases.h"
#include "apps/cli/verify_laws.h"
#include "apps/cli/verify_specimen.h"
#include "core/text.h"
#include "math/splitmix64.h"
#include "mesh/rest_mesh.h"

namespace percale::cli {
namespace {

/// The deformation gradient of a triangle: how the material directions u and v are drawn into space.
struct Gradient {
  Vec3 u, v;
};
Gradient GradientOf(const RestMesh& mesh, std::span<const Vec3> x, std::size_t triangle) {
  const Vec2* p = &mesh.material[3 * triangle];
  const Triangle& t = mesh.triangles[triangle];
  const double u1 = p[1].x - p[0].x, v1 = p[1].y - p[0].y, u2 = p[2].x - p[0].x, v2 = p[2].y - p[0].y;
  const double det = u1 * v2 - u2 * v1;
  const Vec3 e1 = x[std::size_t(t.b)] - x[std::size_t(t.a)], e2 = x[std::size_t(t.c)] - x[std::size_t(t.a)];
  return {(e1 * v2 - e2 * v1) / det, (e2 * u1 - e1 * u2) / det};
}

}  // namespace

CaseResult VerifyHangingSheet(const Effort& effort) {
  constexpr double kLength = 1, kDensity = 0.15, kStiffness = 261;
  const int elements = Elements(20 * effort.mesh, 2);
  Scene scene = EmptyScene();
  scene.cloths.push_back(PlainSheet(kLength, kLength, elements, elements, kDensity, kStiffness, 0, 1e-6));
  PinRow(scene.cloths[0], 0);
  scene.simulation.gravity = {0, 0, kGravity};
  World world(scene, {.threads = 1});
  const bool still = Settle(world);
  const int last = scene.cloths[0].numHeightPoints - 1;
  const Vec3& low = world.Cloth(0).positions()[std::size_t(last * scene.cloths[0].numWidthPoints)];
  CaseResult result;
  result.readings.push_back(Relative("ΔL/L", still ? (low.z - kLength) / kLength : NAN,
                                     kDensity * kGravity * kLength / (2 * kStiffness), 0.01));
  return result;
}

CaseResult VerifyCatenary(const Effort& effort) {
  CaseResult result;
  const int along = Elements(48 * effort.mesh, 8);
  for (const double length : {1.05, 1.1, 1.2, 1.5, 2.0}) {
    Scene scene = EmptyScene(8);  // short steps: it has far to go
    // K is what the strip weighs over 20 km: it stretches by 5e-5.
    constexpr double kDensity = 0.1, kStiffness = 2e4 * kDensity * kGravity;
    ClothSettings cloth = PlainSheet(length, 0.05, along, 1, kDensity, kStiffness, 0, 0);
    PinColumn(cloth, 0);
    PinColumn(cloth, along);
    scene.cloths.push_back(cloth);
    scene.simulation.gravity = {0, -kGravity, 0};
    World world(scene, {.threads = 1});
    // From a parabola of about that length between the two ends.
    const double sag = std::sqrt(3.0 / 8 * (length - 1));
    const auto start = [&](int v) {
      const double s = double(v % (along + 1)) / along;
      return Vec3{s, -4 * sag * s * (1 - s), world.Cloth(0).rest()[std::size_t(v)].z};
    };
    Put(world, start, [](int) { return Vec3{}; });
    const bool still = Settle(world, 1e-8, 500);
    double lowest = 0;
    for (const Vec3& x : world.Cloth(0).positions()) lowest = std::min(lowest, x.y);
    result.readings.push_back(
        Relative("sag at L = " + FormatNumber(length), still ? -lowest : NAN, CatenarySag(length), 0.01));
  }
  return result;
}

CaseResult VerifyPatch(const Effort& effort) {
  // A square of triangles that are anything but alike.
  const int n = Elements(8 * effort.mesh, 2);
  SplitMix64 random(7);
  RestMesh mesh;
  std::vector<std::int32_t> pinned;
  std::vector<Vec2> flat;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool border = i == 0 || j == 0 || i == n || j == n;
      if (border) pinned.push_back(j * (n + 1) + i);
      const auto jitter = [&](bool fixed) { return fixed ? 0 : 0.6 * (random.NextUnit() - 0.5); };
      const double x = i + jitter(i == 0 || i == n), y = j + jitter(j == 0 || j == n);
      flat.push_back({x / n, y / n});
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      if (random.Next() % 2 == 0) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      }
    }
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : {t.a, t.b, t.c}) mesh.material.push_back(flat[std::size_t(v)]);
  }
  // Stretched, sheared, and laid askew into space.
  const Vec3 alongU = Vec3{0.6, 0.64, 0.48} * 1.12 + Vec3{-0.8, 0.48, 0.36} * 0.03;
  const Vec3 alongV = Vec3{0.6, 0.64, 0.48} * 0.1 + Vec3{-0.8, 0.48, 0.36} * 1.08;
  std::vector<Vec3> field, start;
  for (const Vec2& p : flat) {
    mesh.positions.push_back({p.x, 0, -p.y});
    field.push_back(alongU * p.x + alongV * p.y);
  }
  start = field;
  for (std::size_t v = 0; v < start.size(); ++v) {
    if (std::find(pinned.begin(), pinned.end(), std::int32_t(v)) != pinned.end()) continue;
    start[v] += Vec3{random.NextUnit() - 0.5, random.NextUnit() - 0.5, random.NextUnit() - 0.5} * (0.2 / n);
  }
  Scene scene = EmptyScene();
  scene.cloths.push_back(PlainSheet(1, 1, 1, 1, 0.1, 100, 0.3, 0));
  MeshRun run(scene, mesh, pinned);
  CaseResult result;
  // In balance where the field has them; and that is where they go from elsewhere, as near as energies can tell.
  for (const bool away : {false, true}) {
    run.Put(away ? start : field);
    run.Settle(1e-13, 30);
    double off = 0, spread = 0;
    for (std::size_t v = 0; v < field.size(); ++v) off = std::max(off, Length(run.positions()[v] - field[v]));
    const std::array<double, 3> expected = {Dot(alongU, alongU), Dot(alongV, alongV), Dot(alongU, alongV)};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Gradient f = GradientOf(mesh, run.positions(), t);
      const std::array<double, 3> found = {Dot(f.u, f.u), Dot(f.v, f.v), Dot(f.u, f.v)};
      for (std::size_t k = 0; k < 3; ++k) spread = std::max(spread, 0.5 * std::abs(found[k] - expected[k]));
    }
    if (away) {
      result.readings.push_back(
          Absolute("farthest vertex from the field, from elsewhere, over the side", off, 0, 1e-8));
    } else {
      result.readings.push_back(Absolute("farthest vertex from the field, over the side", off, 0, 1e-10));
      result.readings.push_back(Absolute("farthest strain from uniform", spread, 0, 1e-10));
    }
  }
  return result;
}

CaseResult VerifyOrthotropy(const Effort& effort) {
  constexpr double kWarp = 400, kWeft = 200, kPoisson = 0.2, kShear = 80;
  constexpr double kLength = 1, kDensity = 0.1, kPull = 0.4;  // strains of 1e-4
  const int along = Elements(50 * effort.mesh, 10), across = Elements(5 * effort.mesh, 2);
  CaseResult result;
  for (const double angle : {0.0, 45.0, 90.0}) {
    Scene scene = EmptyScene();
    ClothSettings cloth = PlainSheet(kLength, 0.1, along, across, kDensity, kWarp, kPoisson, 1e-6);
    cloth.stretchWeft = kWeft, cloth.shear = kShear, cloth.warpAngle = angle;
    PinColumn(cloth, 0);
    scene.cloths.push_back(cloth);
    scene.simulation.gravity = {kPull, 0, 0};
    World world(scene, {.threads = 1});
    const bool still = Settle(world);
    // How far apart two cross sections in the middle have come: their mean pull is what hangs below midway.
    const int first = 2 * along / 5, last = 3 * along / 5;
    const auto section = [&](int column) {
      double sum = 0;
      for (int j = 0; j <= across; ++j) sum += world.Cloth(0).positions()[std::size_t(j * (along + 1) + column)].x;
      return sum / (across + 1);
    };
    const double rest = kLength * (last - first) / along;
    const double strain = (section(last) - section(first)) / rest - 1;
    const double pull = kDensity * kPull * kLength * (1 - 0.5 * (first + last) / along);
    result.readings.push_back(
        Relative("modulus [N/m] at " + FormatNumber(angle) + "°", still ? pull / strain : NAN,
                 1 / StripCompliance(kWarp, kWeft, kPoisson, kShear, angle * std::numbers::pi / 180), 0.01));
  }
  return result;
}

CaseResult VerifyBalloon(const Effort& effort) {
  // Two discs of radius 1 that share their rim. Foil does not stretch, and around the rim it is in folds finer than any
  // mesh, which bear no load. So each triangle is cut with its warp along the radius, and hardly resists otherwise.
  constexpr double kPressure = 1, kAlong = 1000, kAcross = 1;  // Pa, N/m
  const int rings = Elements(12 * effort.mesh, 4);
  const RestMesh disc = MakeDisc(1, rings);
  const auto count = static_cast<std::int32_t>(disc.positions.size()), rim = count - 6 * rings;
  RestMesh mesh = disc;
  for (std::int32_t v = 0; v < rim; ++v) mesh.positions.push_back(disc.positions[std::size_t(v)]);
  const auto below = [&](std::int32_t v) { return v < rim ? count + v : v; };
  for (std::size_t t = 0; t < disc.triangles.size(); ++t) {
    const Triangle& tri = disc.triangles[t];
    mesh.triangles.push_back({below(tri.a), below(tri.c), below(tri.b)});
    for (const std::size_t k : {0, 2, 1}) {
      const Vec2& p = disc.material[3 * t + k];
      mesh.material.push_back({p.x, -p.y});
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec2* p = &mesh.material[3 * t];
    const double x = p[0].x + p[1].x + p[2].x, y = p[0].y + p[1].y + p[2].y, length = std::hypot(x, y);
    for (int k = 0; k < 3; ++k) p[k] = {(x * p[k].x + y * p[k].y) / length, (x * p[k].y - y * p[k].x) / length};
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& x = mesh.positions[v];
    const double bulge = 0.3 * (1 - Dot(x, x));
    x.y = v < std::size_t(count) ? bulge : -bulge;
  }
  Scene scene = EmptyScene(3);
  scene.cloths.push_back(PlainSheet(1, 1, 1, 1, 0.1, kAlong, 0, 0));
  scene.cloths[0].stretchWeft = scene.cloths[0].shear = kAcross;
  scene.cloths[0].pressure = kPressure;
  MeshRun run(scene, mesh, {});
  const auto volume = [&] {
    double sum = 0;
    const std::span<const Vec3> x = run.positions();
    for (const Triangle& t : mesh.triangles) {
      sum += Dot(x[std::size_t(t.a)], Cross(x[std::size_t(t.b)], x[std::size_t(t.c)])) / 6;
    }
    return sum;
  };
  double before = 0, now = volume();
  constexpr int kMostSteps = 60;
  for (int k = 0; k < kMostSteps && std::abs(now - before) > 1e-6 * now; ++k) {
    run.Step();
    before = std::exchange(now, volume());
  }
  const bool still = std::abs(now - before) <= 1e-6 * now;
  const std::span<const Vec3> ring = run.positions().subspan(std::size_t(rim), std::size_t(count - rim));
  Vec3 centre;
  for (const Vec3& x : ring) centre += x / double(ring.size());
  double radius = 0;
  for (const Vec3& x : ring) radius += Length(x - centre) / double(ring.size());
  CaseResult result;
  result.readings.push_back(Relative("radius r/a", still ? radius : NAN, kBalloonRadius, 0.03));
  result.readings.push_back(Relative("volume V/a³", still ? now : NAN, kBalloonVolume, 0.03));
  return result;
}

}  // namespace percale::cli
