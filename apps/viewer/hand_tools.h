#pragma once
/// \file
/// The hand's tools: grips, balls and gusts, as large and as strong as suits the cloths of a scene.

#include "percale/interaction.h"
#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale::viewer {

/// A grip on a vertex of cloth `index` of the scene, which is at a point.
Handle GripOf(const Scene& scene, int index, int vertex, const Vec3& at);
/// A ball that comes from before a point in a direction.
Ball BallFrom(const Scene& scene, const Vec3& point, const Vec3& direction);
/// A second of wind in a direction.
Gust GustTowards(const Scene& scene, const Vec3& direction);

}  // namespace percale::viewer
