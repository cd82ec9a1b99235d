#pragma once
/// \file
/// The hand's tools: grips, balls and gusts, as large and as strong as suits the cloths of a scene.

#include <span>

#include "percale/interaction.h"
#include "percale/mesh.h"
#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale::viewer {

/// A grip on a vertex of cloth `index` of the scene, which is at a point.
Handle GripOf(const Scene& scene, int index, int vertex, const Vec3& at);
/// `to`, or, where that is farther from `from` than `most` [m], what is so far on the way.
Vec3 Towards(const Vec3& from, const Vec3& to, double most);
/// The target of a grip that is to lead from where its vertex is to where the hand is: no farther ahead than it has
/// strength for. A hand that has run away from the cloth while a frame took long, or to where pins do not let it, would
/// tear at it without bounds.
Vec3 LeadOf(const Handle& grip, const Vec3& at, const Vec3& hand);
/// What of a `way` [m] a hand carries a pin, which gives way to nothing by itself: not farther off where the springs at
/// it are taut already, stretched by half. `positions` [m] are the cloth's, `restLengths` [m] the springs'.
Vec3 CarriedWay(int pin, const Vec3& way, std::span<const Vec3> positions, std::span<const Edge> springs,
                std::span<const double> restLengths);
/// A ball that comes from before a point in a direction.
Ball BallFrom(const Scene& scene, const Vec3& point, const Vec3& direction);
/// A second of wind in a direction.
Gust GustTowards(const Scene& scene, const Vec3& direction);

}  // namespace percale::viewer
