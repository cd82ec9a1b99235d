#include "mesh/pick.h"

#include <cmath>

namespace percale {
namespace {

/// Shears space along the ray's direction, so that the ray becomes the z axis and a triangle is met
/// where, seen along it, it holds the origin (Woop, Benthin and Wald 2013, "Watertight ray/triangle
/// intersection").
class AlongRay {
 public:
  explicit AlongRay(const Vec3& d) {
    const double size[3] = {std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    major_ = size[0] > size[1] ? (size[0] > size[2] ? 0 : 2) : (size[1] > size[2] ? 1 : 2);
    const Vec3 turned = Turn(d);
    shearX_ = turned.x / turned.z;
    shearY_ = turned.y / turned.z;
  }
  Vec2 operator()(const Vec3& p) const {
    const Vec3 q = Turn(p);
    return {q.x - shearX_ * q.z, q.y - shearY_ * q.z};
  }

 private:
  /// With the axis that the ray follows most in place of z.
  Vec3 Turn(const Vec3& p) const { return major_ == 0 ? Vec3{p.y, p.z, p.x} : major_ == 1 ? Vec3{p.z, p.x, p.y} : p; }
  int major_ = 2;
  double shearX_ = 0, shearY_ = 0;
};

/// Twice the area of the origin, a and b. Its sign is never wrong: rounding keeps the order of the two
/// products, or makes them equal.
double Area(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

std::optional<Hit> PickCloth(const Ray& ray, std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::optional<Hit> nearest;
  const AlongRay alongRay(ray.direction);
  const Vec3 unit = ray.direction / Length(ray.direction);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::int32_t vertices[3] = {triangles[i].a, triangles[i].b, triangles[i].c};
    Vec3 p[3];  // seen from the ray's origin
    Vec2 q[3];  // seen along the ray
    for (int k = 0; k < 3; ++k) {
      p[k] = positions[static_cast<std::size_t>(vertices[k])] - ray.origin;
      q[k] = alongRay(p[k]);
    }
    const double areas[3] = {Area(q[1], q[2]), Area(q[2], q[0]), Area(q[0], q[1])};
    const bool within = (areas[0] >= 0 && areas[1] >= 0 && areas[2] >= 0) ||  // false for what is no number
                        (areas[0] <= 0 && areas[1] <= 0 && areas[2] <= 0);
    const double sum = areas[0] + areas[1] + areas[2];
    if (!within || sum == 0) continue;
    Hit hit;
    Vec3 toPoint;
    for (std::size_t k = 0; k < 3; ++k) {
      hit.weights[k] = areas[k] / sum;
      toPoint += hit.weights[k] * p[k];
    }
    hit.distance = Dot(toPoint, unit);
    if (!(hit.distance >= 0) || (nearest && hit.distance >= nearest->distance)) continue;
    hit.triangle = static_cast<std::int32_t>(i);
    hit.point = ray.origin + toPoint;
    int closest = 0;
    for (int k = 1; k < 3; ++k) {
      const Vec3 a = p[k] - toPoint, b = p[closest] - toPoint;
      if (Dot(a, a) < Dot(b, b)) closest = k;
    }
    hit.vertex = vertices[closest];
    nearest = hit;
  }
  return nearest;
}

}  // namespace percale
