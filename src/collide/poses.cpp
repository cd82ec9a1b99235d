#include "collide/poses.h"

#include <algorithm>
#include <cstddef>

namespace percale {
namespace {

double ShareOf(const ColliderMotion& motion, double time) {
  if (motion.jump) return time >= motion.end ? 1 : 0;
  return MotionShare(motion.start, motion.end, motion.steady, time);
}

}  // namespace

Pose PoseOf(const Scene& scene, int collider, double time) {
  const ColliderSettings& settings = scene.colliders[static_cast<std::size_t>(collider)];
  Pose pose{RotationXyz(settings.rotation), settings.position};
  Vec3 way;
  for (const ColliderMotion& motion : scene.colliderMotions) {
    if (motion.collider != collider) continue;
    const double share = ShareOf(motion, time);
    way += motion.displacement * share;
    if (motion.angle == 0 || share == 0) continue;
    const Matrix3<double> turn = RotationAbout(UnitOr(motion.axis, {0, 1, 0}), motion.angle * share);
    pose.rotation = Product(turn, pose.rotation);
    if (!motion.ownCentre) pose.position = motion.centre + Times(turn, pose.position - motion.centre);
  }
  pose.position += way;
  return pose;
}

bool Jumps(const Scene& scene, int collider, double before, double after) {
  return std::any_of(scene.colliderMotions.begin(), scene.colliderMotions.end(), [&](const ColliderMotion& motion) {
    return motion.jump && motion.collider == collider && ShareOf(motion, before) != ShareOf(motion, after);
  });
}

Pose PoseOf(const SphereSettings& sphere) {
  return {Diagonal(1.0), sphere.origin};
}

Pose PoseOf(const PlaneSettings& plane) {
  return {RotationFromY(UnitOr(plane.normal, {0, 1, 0})), plane.point};
}

void ListSolids(const Scene& scene, double time, std::vector<PlacedSolid>& solids) {
  solids.clear();
  for (const SphereSettings& sphere : scene.spheres)
    solids.push_back({MakeSolid(sphere), PoseOf(sphere), sphere.friction, 0, -1});
  for (const PlaneSettings& plane : scene.planes)
    solids.push_back({MakeSolid(plane), PoseOf(plane), plane.friction, 0, -1});
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    const ColliderSettings& settings = scene.colliders[c];
    if (settings.shape == ColliderShape::Mesh) continue;
    const int index = static_cast<int>(c);
    solids.push_back({MakeSolid(settings), PoseOf(scene, index, time), settings.friction, settings.thickness, index});
  }
}

void MoveSolids(const Scene& scene, double time, std::span<PlacedSolid> solids) {
  for (PlacedSolid& placed : solids) {
    if (placed.collider >= 0) placed.pose = PoseOf(scene, placed.collider, time);
  }
}

SolidSample DistanceTo(const PlacedSolid& placed, const Vec3& point) {
  SolidSample sample = DistanceTo(placed.solid, ToLocal(placed.pose, point));
  sample.normal = Times(placed.pose.rotation, sample.normal);
  return sample;
}

}  // namespace percale
