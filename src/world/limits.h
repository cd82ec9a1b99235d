#pragma once
/// \file
/// What a cloth's settings can be and still go well: warnings, the viewer and the report of a
/// divergence name these limits.

#include "mesh/cloth_model.h"
#include "percale/scene.h"

namespace percale {

/// The spring constant [N/m] from which the cloth blows up at a step of `timeStep` [s]. Verlet is
/// stable while 8 ks dt^2 / m < 4: a point among its four neighbours swings at most with the square
/// of the frequency 8 ks / m. Infinity for a cloth without mass, on which no force acts.
double LargestStableKs(const ClothSettings& cloth, double timeStep);

/// The fewest steps per frame at which `cloth.ks` is below that limit; may be more than a scene
/// accepts, INT_MAX if beyond it.
int SmallestStableStepsPerFrame(const ClothSettings& cloth, int framesPerSecond);

/// The thickness [m] above which points of the resting grid are nearer than twice the thickness, so
/// that the sheet swells at once: half the smallest spacing.
double LargestSensibleThickness(const ClothSettings& cloth);

}  // namespace percale
