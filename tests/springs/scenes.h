#pragma once
/// \file
/// Scenes for the tests of the engine and of World, built in code.

#include <span>
#include <string>

#include "bench/plain_twin.h"
#include "math/splitmix64.h"
#include "percale/scene.h"
#include "percale/world.h"
#include "tests/sanitized.h"

namespace percale::test {

inline constexpr const char* kCourseScenes[] = {"pinned2", "pinned4", "sphere", "plane", "selfCollision"};

/// One of the course's five scenes, optionally on another square grid; the thickness then follows
/// the spacing.
Scene CourseScene(const std::string& name, int size = 50);

/// A small scene with one cloth of that grid that lies at y = 1, spacing 0.1 m.
Scene SmallScene(int numWidth, int numHeight);

/// A small scene in which everything is drawn at random: cloths, pins and their motions, colliders,
/// wind, all settings. Stable, so that the twin and the engine can run as long as one likes.
Scene RandomScene(SplitMix64& random);

/// Empty where the positions of all points are equal to the last bit, else the first that differs.
std::string FirstDifference(const bench::PlainTwin& twin, const World& world);

/// Runs twin and World side by side and returns the first difference after any frame, or nothing.
std::string RunBoth(const Scene& scene, int frames, int threads = 1);

/// Whether all positions of all cloths are finite.
bool AllFinite(const World& world);

double LowestY(const World& world);
double HighestY(const World& world);
double MeanY(const World& world);

/// Runs that many frames.
void Run(World& world, int frames);

}  // namespace percale::test
