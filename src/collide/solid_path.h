#pragma once
/// \file
/// A point that moves against a solid that moves. Both are seen from the solid: there the point goes along a straight
/// line, and the distance says how far it may go without looking again.

#include "collide/poses.h"
#include "percale/vec3.h"

namespace percale {

/// A solid at the start and at the end of a step.
struct SolidStep {
  PlacedSolid start, end;
};

/// Where a point meets a solid, or may soon.
struct SolidMeeting {
  bool any = false;
  double gap = 0;    ///< To the surface at the start, the solid's thickness taken off [m].
  Vec3 normal;       ///< Of the surface there, as the step ends.
  Vec3 point;        ///< The point of the surface there, at the end of the step [m].
  Vec3 pointBefore;  ///< The same, at its start [m].
};

/// Of a point that goes from x to y: where it comes nearer than `least`; if nowhere, what it is nearer to than `near`
/// at the start [m].
SolidMeeting Meet(const SolidStep& step, const Vec3& x, const Vec3& y, double least, double near);

/// The end of the way from x to y, put off the solid and cut short so that the point keeps `least` of it, or what it
/// has at the start where that is less. `y` where it starts inside.
Vec3 Outside(const SolidStep& step, const Vec3& x, const Vec3& y, double least);

}  // namespace percale
