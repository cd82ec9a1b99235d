#include "collide/solid_path.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

constexpr int kMostPathAdvances = 48;
/// What is nearer to the least distance than this share of it is there, or the last advances would take for ever.
constexpr double kPathClose = 0.02;
/// A straight way along a round solid comes nearer to it than its ends: so much of the least distance may go.
constexpr double kDip = 0.5;
/// Takes rounding off what may be advanced.
constexpr double kPathSafe = 1 - 1e-9;

Vec3 Between(const Vec3& a, const Vec3& b, double t) {
  return a + (b - a) * t;
}

/// How much of the way from a to b a point can go, in the frame of the solid, until it is as near as `least` (sphere
/// tracing: Hart 1996); 1: all. The plane that touches a convex solid below the point parts them for good where it does
/// at b.
double ShareOf(const PlacedSolid& solid, const Vec3& a, const Vec3& b, double least) {
  const double length = Length(b - a);
  const bool convex = IsConvex(solid.solid);
  double t = 0;
  for (int advance = 0; advance < kMostPathAdvances; ++advance) {
    const Vec3 at = Between(a, b, t);
    const SolidSample sample = DistanceTo(solid.solid, at);
    const double room = sample.distance - solid.thickness - least;
    if (room >= length * (1 - t)) return 1;
    if (convex && room + Dot(sample.normal, b - at) >= 0) return 1;
    if (!(room > kPathClose * least)) break;
    t += kPathSafe * room / length;
    if (t >= 1) return 1;
  }
  return t;
}

}  // namespace

SolidMeeting Meet(const SolidStep& step, const Vec3& x, const Vec3& y, double least, double near) {
  const Vec3 a = ToLocal(step.start.pose, x), b = ToLocal(step.end.pose, y);
  const SolidSample start = DistanceTo(step.start.solid, a);
  const double thickness = step.start.thickness;
  SolidMeeting meeting;
  meeting.gap = start.distance - thickness;
  const double floor = std::min(least, 0.999 * meeting.gap);
  const bool inside = !(meeting.gap > 0);
  if (!inside && meeting.gap > std::max(near, Length(b - a) + least)) return meeting;
  const double share = inside ? 1 : ShareOf(step.start, a, b, kDip * floor);
  if (share == 1 && meeting.gap >= near) return meeting;
  meeting.any = true;
  // Where the way is free its end counts: on a solid that turns under it a point does not stay.
  const Vec3 at = inside ? a : Between(a, b, share);
  const SolidSample there = inside ? start : DistanceTo(step.start.solid, at);
  const Vec3 surface = at - there.normal * (there.distance - thickness);
  meeting.normal = Times(step.end.pose.rotation, there.normal);
  meeting.point = ToWorld(step.end.pose, surface);
  meeting.pointBefore = ToWorld(step.start.pose, surface);
  return meeting;
}

Vec3 Outside(const SolidStep& step, const Vec3& x, const Vec3& y, double least) {
  const Vec3 a = ToLocal(step.start.pose, x);
  Vec3 b = ToLocal(step.end.pose, y);
  const double thickness = step.start.thickness;
  const double gap = DistanceTo(step.start.solid, a).distance - thickness;
  if (gap > Length(b - a) + least || !(gap > 0)) return y;
  const double floor = std::min(least, 0.999 * gap);
  const SolidSample end = DistanceTo(step.start.solid, b);
  const double missing = (1 + kPathClose) * floor - (end.distance - thickness);
  const bool off = missing > 0;
  if (off) b += end.normal * missing;
  const double share = ShareOf(step.start, a, b, kDip * floor);
  if (share == 1) return off ? ToWorld(step.end.pose, b) : y;
  // What is left of the way goes along the plane that touches there.
  const Vec3 at = Between(a, b, share), normal = DistanceTo(step.start.solid, at).normal;
  const Vec3 along = b - normal * std::min(Dot(b - at, normal), 0.0);
  return ToWorld(step.end.pose, Between(at, along, ShareOf(step.start, at, along, kDip * floor)));
}

}  // namespace percale
