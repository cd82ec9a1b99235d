#pragma once
/// \file
/// Colliders whose vertices move by a cache.

#include <span>

#include "percale/scene.h"

namespace percale {

/// Whether the collider is a mesh that moves by a cache, and holds both.
bool HasCache(const ColliderSettings& settings);

/// Whether the collider names a cache that it does not hold, or holds for another mesh.
bool LacksCache(const ColliderSettings& settings);

/// The time between two samples of the collider's cache [s]: by its `cache_rate`, or else as the file has it. Where a
/// format leaves open whether that is seconds or frames: nobody takes less than five samples per second or more than
/// five per frame.
double SampleSeconds(const Scene& scene, const ColliderSettings& settings);

/// Where the vertices of a mesh are at `time` [s], in the collider's frame [m]: between two samples of its cache on the
/// straight line, before the first and after the last at rest there; without a cache as in the file. Depends on nothing
/// else: the same settings and time give the same bits.
void PlaceVertices(const Scene& scene, const ColliderSettings& settings, double time, std::span<Vec3> positions);

}  // namespace percale
