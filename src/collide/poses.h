#pragma once
/// \file
/// Where the colliders of a scene are at a time.

#include <span>
#include <vector>

#include "collide/shapes.h"
#include "math/pose.h"
#include "percale/scene.h"

namespace percale {

/// Where collider `collider` of the scene is at `time` [s]. Depends on nothing else: the same settings and time give
/// the same bits.
Pose PoseOf(const Scene& scene, int collider, double time);
/// Whether a motion lets the collider jump after `before` and until `after` [s].
bool Jumps(const Scene& scene, int collider, double before, double after);
/// Of a sphere of the course, and of a plane, whose normal is y in its frame. They do not move.
Pose PoseOf(const SphereSettings& sphere);
Pose PoseOf(const PlaneSettings& plane);

/// A solid in the world.
struct PlacedSolid {
  Solid solid;
  Pose pose;
  double friction = 0;   ///< Coulomb's coefficient.
  double thickness = 0;  ///< Cloth keeps so much farther off [m].
  int collider = -1;     ///< Index among Scene::colliders, or -1: does not move.
};

/// All that is given by a formula, as at `time` [s]: the spheres, the planes, then the colliders that are no meshes,
/// each in the scene's order. `solids` is replaced.
void ListSolids(const Scene& scene, double time, std::vector<PlacedSolid>& solids);
/// Puts those of the same scene where they are at another time.
void MoveSolids(const Scene& scene, double time, std::span<PlacedSolid> solids);

/// The distance of a point in the world, and the normal there; the thickness is not taken off.
SolidSample DistanceTo(const PlacedSolid& placed, const Vec3& point);

}  // namespace percale
