#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/cloth_model.h"
#include "mesh/rest_mesh.h"

namespace percale {
namespace {

// The course's camera. Steps and limits are multiples of the scene's extent.
constexpr double kVerticalDegrees = 35;
constexpr double kHorizontalDegrees = 50;
constexpr double kNearPlane = 0.01;  // [m]
constexpr double kFarPlane = 10000;  // [m]
constexpr double kStartDistance = 1.8;
constexpr double kPanDistance = 0.9;
constexpr double kDollyStep = 0.09;
constexpr double kMinDistance = 0.09;
constexpr double kMaxDistance = 18;
constexpr double kMaxElevation = 89;  // [degree]; at 90 the picture has no upward direction.

double Radians(double degrees) {
  return degrees * (std::numbers::pi / 180);
}

}  // namespace

OrbitCamera OrbitCamera::ForScene(const Scene& scene) {
  OrbitCamera camera;
  Vec3 sum, low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  double count = 0, extent = 0;
  bool allGrids = true;
  for (const ClothSettings& cloth : scene.cloths) {
    const bool grid = cloth.shape == Shape::Grid && cloth.rotation == Vec3{};
    allGrids = allGrids && grid;
    for (const Vec3& x : grid ? MakeGrid(cloth).start : MakeClothMesh(cloth).positions) {
      sum += x;
      count += 1;
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    extent = std::max(extent, SizeOf(cloth).extent);
  }
  if (count > 0) {
    // One cloth: its own extent, which its box can exceed by rounding only.
    if (scene.cloths.size() > 1) extent = std::max({extent, high.x - low.x, high.y - low.y, high.z - low.z});
    camera.extent_ = extent;
    // The course looks at half of a sheet's height, where the sheet will hang.
    camera.target_ = allGrids ? Vec3{sum.x / count, sum.y / count / 2, sum.z / count} : 0.5 * (low + high);
    camera.distance_ = kStartDistance * extent;
  }
  if (!scene.camera.automatic) {
    camera.target_ = scene.camera.target;
    camera.distance_ = scene.camera.distance;
    camera.azimuth_ = scene.camera.azimuth;
    camera.elevation_ = std::clamp(scene.camera.elevation, -kMaxElevation, kMaxElevation);
  }
  return camera;
}

void OrbitCamera::Orbit(double dx, double dy, int width, int height) {
  azimuth_ = std::remainder(azimuth_ - 180 * dx / width, 360.0);
  elevation_ = std::clamp(elevation_ + 180 * dy / height, -kMaxElevation, kMaxElevation);
}

void OrbitCamera::Pan(double dx, double dy, int width, int height) {
  const double metresPerPixel = kPanDistance * extent_ * 2 * std::tan(VerticalAngle(width, height) / 2) / height;
  target_ += metresPerPixel * (dy * up() - dx * right());
}

void OrbitCamera::Dolly(double steps) {
  distance_ = std::clamp(distance_ - steps * kDollyStep * extent_, kMinDistance * extent_, kMaxDistance * extent_);
}

double OrbitCamera::VerticalAngle(int width, int height) {
  const double vertical = std::tan(Radians(kVerticalDegrees) / 2);
  const double horizontal = std::tan(Radians(kHorizontalDegrees) / 2);
  return 2 * std::atan(std::max(vertical, horizontal * height / width));
}

Mat4 OrbitCamera::ViewProjection(int width, int height) const {
  return Perspective(VerticalAngle(width, height), double(width) / height, kNearPlane, kFarPlane) *
         LookAt(position(), target_, {0, 1, 0});
}

Vec3 OrbitCamera::position() const {
  const double a = Radians(azimuth_), e = Radians(elevation_);
  return target_ + distance_ * Vec3{std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

Vec3 OrbitCamera::right() const {
  return {std::cos(Radians(azimuth_)), 0, -std::sin(Radians(azimuth_))};
}

Vec3 OrbitCamera::up() const {
  return Cross(UnitOr(position() - target_, {0, 0, 1}), right());
}

Vec3 OrbitCamera::Ray(double x, double y, int width, int height) const {
  const double top = std::tan(VerticalAngle(width, height) / 2);
  const double across = (2 * (x + 0.5) / width - 1) * top * width / height;
  const double above = (1 - 2 * (y + 0.5) / height) * top;
  const Vec3 forward = UnitOr(target_ - position(), {0, 0, -1});
  return UnitOr(forward + across * right() + above * up(), forward);
}

CameraSettings OrbitCamera::Settings() const {
  return {.automatic = false, .target = target_, .distance = distance_, .azimuth = azimuth_, .elevation = elevation_};
}

}  // namespace percale
