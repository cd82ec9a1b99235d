#pragma once
/// \file
/// On which side a point lies, and what meets what, without an error. Plain arithmetic decides where its error bound
/// allows, exact arithmetic on expansions (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust
/// geometric predicates", sections 2 and 4) where it does not.
///
/// The answers are exact where each coordinate is 0 or between kSmallestExact and kLargestExact in size. Smaller ones
/// do no harm, but count only about; larger ones, infinities and NaN must not occur.

#include "percale/vec3.h"

namespace percale {

/// A coordinate of these sizes [m], cubed, neither overflows nor loses its last bit to underflow.
constexpr double kSmallestExact = 1e-90;
constexpr double kLargestExact = 1e90;

/// The sign of the determinant of the rows a - d, b - d, c - d: 1 where the corners a, b, c turn counter-clockwise as
/// seen from the side that d is not on, -1 where they turn clockwise, 0 where the four lie in a plane.
int Orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The sign of the area of the triangle a, b, c: 1 where it turns counter-clockwise, 0 where the three lie on a line.
int Orient2d(const Vec2& a, const Vec2& b, const Vec2& c);

/// Whether a segment p q and a triangle a b c have a point in common, ends and sides included. Either may have
/// collapsed to less.
bool SegmentMeetsTriangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Whether a segment from the corner a of a triangle to q has more than a in common with it: it lies in its plane and
/// runs over it or along a side. True as well where q lies on a.
bool SegmentRunsOnTriangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// The signs by exact arithmetic alone: the plain twins, for tests.
int ExactOrient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int ExactOrient2d(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace percale
