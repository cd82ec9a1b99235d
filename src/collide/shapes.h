#pragma once
/// \file
/// Solids given by formulas, and how far a point is from their surface: exactly, inside as well as outside.

#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale {

/// A solid in its own frame: around the origin, its axis along y; a plane is all that lies below y = 0. Only what its
/// kind needs is set.
struct Solid {
  ColliderShape kind = ColliderShape::Sphere;  ///< Not Mesh.
  Vec3 half;                                   ///< Of a box: half its edges [m].
  double radius = 0;                           ///< As ColliderSettings has it [m].
  double halfLength = 0;                       ///< Of a capsule (its caps' centres), cylinder or cone, along y [m].
  double tubeRadius = 0;                       ///< Of a torus [m].
};

/// The solid of a collider that is no mesh, of a sphere, of a plane.
Solid MakeSolid(const ColliderSettings& collider);
Solid MakeSolid(const SphereSettings& sphere);
Solid MakeSolid(const PlaneSettings& plane);

/// How a point lies to a solid.
struct SolidSample {
  double distance = 0;  ///< To the nearest point of its surface [m]; negative inside.
  Vec3 normal;  ///< Where the distance grows fastest, of length 1: at a point of the surface its normal, outwards.
                ///< Where several directions are as good, on axes and in centres, always the same one of them.
};

/// The distance of `point`, in the solid's frame [m].
SolidSample DistanceTo(const Solid& solid, const Vec3& point);

/// Whether the solid is convex: then it lies on one side of the plane through a point of its surface across the normal
/// there.
bool IsConvex(const Solid& solid);

/// The corner of the smallest box around the origin that holds the solid [m]; infinite for a plane.
Vec3 HalfExtent(const Solid& solid);

}  // namespace percale
