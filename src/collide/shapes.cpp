#include "collide/shapes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace percale {
namespace {

// The distances are those of Inigo Quilez, "Distance functions" (iquilezles.org/articles/distfunctions), with the
// normals worked out beside them, and his cone and cylinder cut down to a profile in a plane through the axis.

/// Below this a length is so rough that it has no direction [m].
constexpr double kNoDirection = 1e-100;

/// A point in the plane through the axis of a solid of revolution: its distance from the axis, and its height.
struct Profile {
  double w = 0, y = 0;
};
double Dot(const Profile& a, const Profile& b) {
  return a.w * b.w + a.y * b.y;
}
Profile operator-(const Profile& a, const Profile& b) {
  return {a.w - b.w, a.y - b.y};
}

/// Distance and normal in that plane.
struct ProfileSample {
  double distance = 0;
  Profile normal;
};

/// A convex corner that lies nearest; `fallback` is the normal in the corner itself.
ProfileSample FromCorner(const Profile& point, const Profile& corner, const Profile& fallback) {
  const Profile d = point - corner;
  const double distance = std::hypot(d.w, d.y);
  return {distance, distance > kNoDirection ? Profile{d.w / distance, d.y / distance} : fallback};
}

/// Cut out of the half plane by |y| <= halfLength and w <= radius.
ProfileSample ToCylinder(const Solid& solid, const Profile& p) {
  const double side = p.y < 0 ? -1 : 1;
  const double w = p.w - solid.radius, y = std::abs(p.y) - solid.halfLength;
  if (w > 0 && y > 0) return FromCorner(p, {solid.radius, side * solid.halfLength}, {1, 0});
  if (w > y) return {w, {1, 0}};
  return {y, {0, side}};
}

/// The triangle of the base from the axis to the rim, the slant from the rim to the tip, and the axis.
ProfileSample ToCone(const Solid& solid, const Profile& p) {
  const double height = 2 * solid.halfLength, slant = std::hypot(solid.radius, height);
  const Profile rim{solid.radius, -solid.halfLength}, tip{0, solid.halfLength};
  const Profile normal{height / slant, solid.radius / slant}, along{-solid.radius / slant, height / slant};
  const double aboveSlant = Dot(p - rim, normal), belowBase = -solid.halfLength - p.y;
  if (aboveSlant <= 0 && belowBase <= 0) {
    // Inside of what is convex the nearest of the planes that bound it is the nearest of its surface.
    if (aboveSlant > belowBase) return {aboveSlant, normal};
    return {belowBase, {0, -1}};
  }
  const double t = Dot(p - rim, along);  // from the rim to the tip [m]
  if (aboveSlant > 0 && t >= 0 && t <= slant) return {aboveSlant, normal};
  if (belowBase > 0 && p.w <= solid.radius) return {belowBase, {0, -1}};
  return t > slant ? FromCorner(p, tip, {0, 1}) : FromCorner(p, rim, normal);
}

ProfileSample ToTorus(const Solid& solid, const Profile& p) {
  ProfileSample sample = FromCorner(p, {solid.radius, 0}, {1, 0});
  sample.distance -= solid.tubeRadius;
  return sample;
}

/// Turns a profile back around the axis.
SolidSample Revolved(const Solid& solid, const Vec3& point, ProfileSample (*distance)(const Solid&, const Profile&)) {
  const double w = std::hypot(point.x, point.z);
  const ProfileSample sample = distance(solid, {w, point.y});
  const Vec3 out = w > kNoDirection ? Vec3{point.x / w, 0, point.z / w} : Vec3{1, 0, 0};
  return {sample.distance, out * sample.normal.w + Vec3{0, sample.normal.y, 0}};
}

SolidSample ToBall(const Vec3& fromCentre, double radius, const Vec3& fallback) {
  const double length = Length(fromCentre);
  return {length - radius, length > kNoDirection ? fromCentre / length : fallback};
}

SolidSample ToBox(const Vec3& half, const Vec3& p) {
  const auto sign = [](double x) { return x < 0 ? -1.0 : 1.0; };
  const Vec3 side{sign(p.x), sign(p.y), sign(p.z)};
  const Vec3 beyond{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
  const Vec3 out{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
  if (const double distance = Length(out); distance > kNoDirection) {
    return {distance, Vec3{side.x * out.x, side.y * out.y, side.z * out.z} / distance};
  }
  if (beyond.x >= beyond.y && beyond.x >= beyond.z) return {beyond.x, {side.x, 0, 0}};
  if (beyond.y >= beyond.z) return {beyond.y, {0, side.y, 0}};
  return {beyond.z, {0, 0, side.z}};
}

}  // namespace

Solid MakeSolid(const ColliderSettings& collider) {
  Solid solid;
  solid.kind = collider.shape;
  switch (collider.shape) {
    case ColliderShape::Sphere:
      solid.radius = collider.radius;
      break;
    case ColliderShape::Plane:
      break;
    case ColliderShape::Box:
      solid.half = collider.size * 0.5;
      break;
    case ColliderShape::Capsule:
    case ColliderShape::Cylinder:
    case ColliderShape::Cone:
      solid.radius = collider.radius;
      solid.halfLength = collider.length / 2;
      break;
    case ColliderShape::Torus:
      solid.radius = collider.radius;
      solid.tubeRadius = collider.tubeRadius;
      break;
    case ColliderShape::Mesh:
      assert(!"A mesh is no solid of a formula.");
      break;
  }
  return solid;
}
Solid MakeSolid(const SphereSettings& sphere) {
  return {ColliderShape::Sphere, {}, sphere.radius, 0, 0};
}
Solid MakeSolid(const PlaneSettings&) {
  return {ColliderShape::Plane, {}, 0, 0, 0};
}

SolidSample DistanceTo(const Solid& solid, const Vec3& point) {
  switch (solid.kind) {
    case ColliderShape::Sphere:
      return ToBall(point, solid.radius, {0, 1, 0});
    case ColliderShape::Plane:
      return {point.y, {0, 1, 0}};
    case ColliderShape::Box:
      return ToBox(solid.half, point);
    case ColliderShape::Capsule: {
      const double y = std::clamp(point.y, -solid.halfLength, solid.halfLength);
      return ToBall(point - Vec3{0, y, 0}, solid.radius, {1, 0, 0});
    }
    case ColliderShape::Cylinder:
      return Revolved(solid, point, ToCylinder);
    case ColliderShape::Cone:
      return Revolved(solid, point, ToCone);
    case ColliderShape::Torus:
      return Revolved(solid, point, ToTorus);
    case ColliderShape::Mesh:
      break;
  }
  assert(!"A mesh has no formula.");
  return {};
}

bool IsConvex(const Solid& solid) {
  return solid.kind != ColliderShape::Torus;
}

Vec3 HalfExtent(const Solid& solid) {
  const double r = solid.radius, far = std::numeric_limits<double>::infinity();
  switch (solid.kind) {
    case ColliderShape::Sphere:
      return {r, r, r};
    case ColliderShape::Plane:
      return {far, far, far};
    case ColliderShape::Box:
      return solid.half;
    case ColliderShape::Capsule:
      return {r, r + solid.halfLength, r};
    case ColliderShape::Cylinder:
    case ColliderShape::Cone:
      return {r, solid.halfLength, r};
    case ColliderShape::Torus:
      return {r + solid.tubeRadius, solid.tubeRadius, r + solid.tubeRadius};
    case ColliderShape::Mesh:
      break;
  }
  assert(!"A mesh has no formula.");
  return {};
}

}  // namespace percale
