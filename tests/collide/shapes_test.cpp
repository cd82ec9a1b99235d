#include "collide/shapes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "math/splitmix64.h"

using namespace percale;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoot2 = std::numbers::sqrt2;

struct Named {
  std::string name;
  Solid solid;
};

Solid Make(ColliderShape shape, double radius, double length) {
  ColliderSettings settings;
  settings.shape = shape;
  settings.size = {0.6, 0.3, 1};
  settings.radius = radius;
  settings.length = length;
  settings.tubeRadius = 0.15;
  return MakeSolid(settings);
}

/// One of each kind that is bounded, and such as are flat or thin.
std::vector<Named> Solids() {
  return {{"sphere", Make(ColliderShape::Sphere, 0.4, 1)},     {"box", Make(ColliderShape::Box, 1, 1)},
          {"capsule", Make(ColliderShape::Capsule, 0.2, 0.6)}, {"cylinder", Make(ColliderShape::Cylinder, 0.3, 0.8)},
          {"disc", Make(ColliderShape::Cylinder, 0.5, 0.1)},   {"cone", Make(ColliderShape::Cone, 0.4, 0.7)},
          {"flat cone", Make(ColliderShape::Cone, 0.6, 0.2)},  {"needle", Make(ColliderShape::Cone, 0.1, 0.9)},
          {"torus", Make(ColliderShape::Torus, 0.4, 1)}};
}

std::vector<double> Spread(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

/// Adds the surface swept by a point of a profile around the axis.
void AddRing(double w, double y, std::vector<Vec3>& points) {
  const int count = std::max(1, static_cast<int>(2 * kPi * w / 0.005));
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * kPi * k / count;
    points.push_back({w * std::cos(angle), y, w * std::sin(angle)});
  }
}

/// Points of the surface, at most about 0.006 apart, from its parametrization.
std::vector<Vec3> Surface(const Solid& s) {
  std::vector<Vec3> points;
  const int n = 200;
  switch (s.kind) {
    case ColliderShape::Sphere:
      for (const double a : Spread(0, kPi, 2 * n)) AddRing(s.radius * std::sin(a), s.radius * std::cos(a), points);
      break;
    case ColliderShape::Box:
      for (int axis = 0; axis < 3; ++axis) {
        for (const double u : Spread(-1, 1, n)) {
          for (const double v : Spread(-1, 1, n)) {
            const Vec3 h = s.half;
            for (const double side : {-1.0, 1.0}) {
              points.push_back(axis == 0   ? Vec3{side * h.x, u * h.y, v * h.z}
                               : axis == 1 ? Vec3{u * h.x, side * h.y, v * h.z}
                                           : Vec3{u * h.x, v * h.y, side * h.z});
            }
          }
        }
      }
      break;
    case ColliderShape::Capsule:
      for (const double y : Spread(-s.halfLength, s.halfLength, n)) AddRing(s.radius, y, points);
      for (const double a : Spread(0, kPi / 2, n)) {
        AddRing(s.radius * std::cos(a), s.halfLength + s.radius * std::sin(a), points);
        AddRing(s.radius * std::cos(a), -s.halfLength - s.radius * std::sin(a), points);
      }
      break;
    case ColliderShape::Cylinder:
      for (const double y : Spread(-s.halfLength, s.halfLength, n)) AddRing(s.radius, y, points);
      for (const double w : Spread(0, s.radius, n)) {
        AddRing(w, s.halfLength, points);
        AddRing(w, -s.halfLength, points);
      }
      break;
    case ColliderShape::Cone:
      for (const double t : Spread(0, 1, n)) {
        AddRing(s.radius * t, s.halfLength * (1 - 2 * t), points);
        AddRing(s.radius * t, -s.halfLength, points);
      }
      break;
    case ColliderShape::Torus:
      for (const double a : Spread(0, 2 * kPi, 2 * n))
        AddRing(s.radius + s.tubeRadius * std::cos(a), s.tubeRadius * std::sin(a), points);
      break;
    default:
      break;
  }
  return points;
}

/// By its definition, apart from any distance.
bool IsInside(const Solid& s, const Vec3& p) {
  const double w = std::hypot(p.x, p.z);
  switch (s.kind) {
    case ColliderShape::Sphere:
      return Length(p) < s.radius;
    case ColliderShape::Box:
      return std::abs(p.x) < s.half.x && std::abs(p.y) < s.half.y && std::abs(p.z) < s.half.z;
    case ColliderShape::Capsule:
      return Length(p - Vec3{0, std::clamp(p.y, -s.halfLength, s.halfLength), 0}) < s.radius;
    case ColliderShape::Cylinder:
      return w < s.radius && std::abs(p.y) < s.halfLength;
    case ColliderShape::Cone:
      return p.y > -s.halfLength && w < s.radius * (s.halfLength - p.y) / (2 * s.halfLength);
    case ColliderShape::Torus:
      return std::hypot(w - s.radius, p.y) < s.tubeRadius;
    default:
      return false;
  }
}

Vec3 Somewhere(SplitMix64& random, double half) {
  const double x = random.NextUnit(), y = random.NextUnit(), z = random.NextUnit();
  return 2 * half * (Vec3{x, y, z} - Vec3{0.5, 0.5, 0.5});
}

void Check(const SolidSample& sample, double distance, const Vec3& normal) {
  CHECK(sample.distance == doctest::Approx(distance).epsilon(1e-14));
  CHECK(Length(sample.normal - normal) < 1e-14);
}

}  // namespace

TEST_CASE("the distance is that to the nearest of many points of the surface, and has the side's sign") {
  for (const auto& [name, solid] : Solids()) {
    CAPTURE(name);
    const std::vector<Vec3> surface = Surface(solid);
    double farthest = 0;
    for (const Vec3& p : surface) farthest = std::max(farthest, std::abs(DistanceTo(solid, p).distance));
    CHECK(farthest < 1e-12);
    SplitMix64 random(7);
    int inside = 0;
    for (int k = 0; k < 300; ++k) {
      const Vec3 p = Somewhere(random, k % 2 == 0 ? 0.9 : 0.35);
      double nearest = 1e9;
      for (const Vec3& q : surface) nearest = std::min(nearest, Length(p - q));
      const double distance = DistanceTo(solid, p).distance;
      // A sample is never nearer than the surface, and some sample is at most 0.005 beside the nearest point.
      CHECK(nearest >= std::abs(distance) - 1e-12);
      CHECK(nearest <= std::hypot(distance, 0.005) + 1e-3);
      CHECK((distance < 0) == IsInside(solid, p));
      inside += distance < 0;
    }
    CHECK(inside >= 2);
  }
}

TEST_CASE("along the normal lies the nearest point of the surface") {
  std::vector<Named> solids = Solids();
  solids.push_back({"plane", {ColliderShape::Plane, {}, 0, 0, 0}});
  for (const auto& [name, solid] : solids) {
    CAPTURE(name);
    SplitMix64 random(11);
    for (int k = 0; k < 2000; ++k) {
      const Vec3 p = Somewhere(random, k % 2 == 0 ? 0.9 : 0.3);
      const SolidSample sample = DistanceTo(solid, p);
      CHECK(Length(sample.normal) == doctest::Approx(1).epsilon(1e-14));
      CHECK(std::abs(DistanceTo(solid, p - sample.normal * sample.distance).distance) < 1e-13);
    }
  }
}

TEST_CASE("the normal is the gradient, and the distance grows no faster than the way") {
  for (const auto& [name, solid] : Solids()) {
    CAPTURE(name);
    SplitMix64 random(13);
    int compared = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 p = Somewhere(random, k % 2 == 0 ? 0.9 : 0.3), q = Somewhere(random, 0.9);
      const double here = DistanceTo(solid, p).distance;
      CHECK(std::abs(here - DistanceTo(solid, q).distance) <= Length(p - q) + 1e-13);
      const Vec3 near = p + Somewhere(random, 1e-3);
      CHECK(std::abs(here - DistanceTo(solid, near).distance) <= Length(p - near) + 1e-13);

      constexpr double kStep = 1e-6;
      const auto slope = [&](const Vec3& axis) {
        return (DistanceTo(solid, p + axis * kStep).distance - DistanceTo(solid, p - axis * kStep).distance) /
               (2 * kStep);
      };
      const Vec3 gradient{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
      // Where two points of the surface are as near, the distance has a kink; few points come that close.
      if (std::abs(Length(gradient) - 1) > 1e-5) continue;
      ++compared;
      CHECK(Length(gradient - DistanceTo(solid, p).normal) < 1e-4);
    }
    CHECK(compared > 1980);
  }
}

TEST_CASE("the normal has length 1 in centres, on axes and in corners, and ever so near to them") {
  for (const auto& [name, solid] : Solids()) {
    CAPTURE(name);
    const double h = solid.halfLength, r = solid.radius;
    for (const Vec3& at : {Vec3{}, Vec3{0, h, 0}, Vec3{0, -h, 0}, Vec3{0, 0.1, 0}, Vec3{r, h, 0}, Vec3{0, -h, r},
                           Vec3{0, 0, r}, solid.half, -solid.half}) {
      for (const double off : {0.0, 5e-324, 1e-310, 1e-160, 1e-90, 1e-30, 1e-17, 1e-9}) {
        for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{1, 1, 1}, Vec3{-1, 1, -1}}) {
          const SolidSample sample = DistanceTo(solid, at + way * off);
          CHECK(std::abs(Length(sample.normal) - 1) < 1e-14);
          CHECK(std::abs(sample.distance - DistanceTo(solid, at).distance) <= 2 * off + 1e-15);
        }
      }
    }
  }
}

TEST_CASE("corners, edges and faces of a box") {
  const Solid box = Make(ColliderShape::Box, 1, 1);  // half 0.3, 0.15, 0.5
  const double third = 1 / std::sqrt(3.0);
  Check(DistanceTo(box, {0.4, 0.25, 0.6}), 0.1 / third, {third, third, third});
  Check(DistanceTo(box, {-0.4, 0.25, 0.1}), 0.1 * kRoot2, {-1 / kRoot2, 1 / kRoot2, 0});
  Check(DistanceTo(box, {0.1, -0.35, 0.1}), 0.2, {0, -1, 0});
  Check(DistanceTo(box, {0, 0, 0}), -0.15, {0, 1, 0});
  Check(DistanceTo(box, {0.28, 0.1, 0}), -0.02, {1, 0, 0});
  CHECK(DistanceTo(box, box.half).distance == 0);
  CHECK(Length(DistanceTo(box, box.half).normal) == 1);
}

TEST_CASE("the rim, the axis and the lids of a cylinder; the ends of a capsule") {
  const Solid cylinder = Make(ColliderShape::Cylinder, 0.3, 0.8);
  Check(DistanceTo(cylinder, {0, 0.5, 0.4}), 0.1 * kRoot2, {0, 1 / kRoot2, 1 / kRoot2});
  Check(DistanceTo(cylinder, {0, 0, 0}), -0.3, {1, 0, 0});
  Check(DistanceTo(cylinder, {0, -0.3, 0}), -0.1, {0, -1, 0});
  Check(DistanceTo(cylinder, {0, 1, 0}), 0.6, {0, 1, 0});
  Check(DistanceTo(cylinder, {0, 0.1, -0.7}), 0.4, {0, 0, -1});

  const Solid capsule = Make(ColliderShape::Capsule, 0.2, 0.6);
  Check(DistanceTo(capsule, {0, 0.9, 0}), 0.4, {0, 1, 0});
  Check(DistanceTo(capsule, {0, 0.3, 0}), -0.2, {1, 0, 0});
  Check(DistanceTo(capsule, {0.3, -0.7, 0}), 0.3, {0.6, -0.8, 0});
}

TEST_CASE("the tip, the rim and the axis of a cone") {
  const Solid cone = Make(ColliderShape::Cone, 0.3, 0.4);  // tip at y = 0.2; the slant is a 3-4-5 triangle
  Check(DistanceTo(cone, {0, 0.5, 0}), 0.3, {0, 1, 0});
  Check(DistanceTo(cone, {0, 0.2, 0}), 0, {0.8, 0.6, 0});
  Check(DistanceTo(cone, {0, -0.1, 0}), -0.1, {0, -1, 0});
  Check(DistanceTo(cone, {0, 0.1, 0}), -0.06, {0.8, 0.6, 0});
  Check(DistanceTo(cone, {0.3 + 0.3, -0.2 - 0.4, 0}), 0.5, {0.6, -0.8, 0});
  Check(DistanceTo(cone, {0.15 + 0.8, 0.6, 0}), 1, {0.8, 0.6, 0});
  Check(DistanceTo(cone, {0, -0.5, 0.1}), 0.3, {0, -1, 0});
}

TEST_CASE("the hole and the ring of a torus") {
  const Solid torus = Make(ColliderShape::Torus, 0.4, 1);
  Check(DistanceTo(torus, {0, 0, 0}), 0.25, {-1, 0, 0});
  Check(DistanceTo(torus, {0, 0, 0.4}), -0.15, {0, 0, 1});
  Check(DistanceTo(torus, {0.4, 0.5, 0}), 0.35, {0, 1, 0});
  CHECK_FALSE(IsConvex(torus));
}

TEST_CASE("a solid lies within its extent, and touches it") {
  for (const auto& [name, solid] : Solids()) {
    CAPTURE(name);
    const Vec3 half = HalfExtent(solid);
    Vec3 farthest;
    for (const Vec3& p : Surface(solid)) {
      farthest = {std::max(farthest.x, p.x), std::max(farthest.y, p.y), std::max(farthest.z, p.z)};
    }
    for (const auto& [bound, found] : {std::pair{half.x, farthest.x}, {half.y, farthest.y}, {half.z, farthest.z}}) {
      CHECK(found <= bound + 1e-12);
      CHECK(found >= bound - 1e-3);
    }
  }
}

TEST_CASE("a convex solid lies behind the plane of its nearest point") {
  for (const auto& [name, solid] : Solids()) {
    if (!IsConvex(solid)) continue;
    CAPTURE(name);
    SplitMix64 random(17);
    const std::vector<Vec3> surface = Surface(solid);
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = Somewhere(random, 0.9);
      const SolidSample sample = DistanceTo(solid, p);
      const Vec3 foot = p - sample.normal * sample.distance;
      double beyond = 0;
      for (const Vec3& q : surface) beyond = std::max(beyond, Dot(q - foot, sample.normal));
      CHECK(beyond < 1e-12);
    }
  }
}
