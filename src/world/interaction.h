#pragma once
/// \file
/// Balls in flight.

#include <vector>

#include "percale/interaction.h"
#include "percale/scene.h"

namespace percale {

/// Moves the balls by one step of `dt` [s] that ends at `time` [s]: they fall, and bounce off the scene's spheres and
/// planes, of a plane on the side that they come from; with Engine::Fabric off all colliders but meshes, as those move.
/// A bounce gives back half of the speed along the normal and takes of the rest by Coulomb's law. Balls more than 100 m
/// away are dropped.
void MoveBalls(const Scene& scene, double time, double dt, std::vector<Ball>& balls);

}  // namespace percale
