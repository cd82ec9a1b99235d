#pragma once
/// \file
/// Where a rigid thing is and how it is turned, and how motions in time carry it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/vector3.h"

namespace percale {

/// World from local: a point p goes to rotation p + position.
struct Pose {
  Matrix3<double> rotation = Diagonal(1.0);
  Vec3 position;  ///< Of the local origin [m].
};

/// a v, and aᵀ v.
inline Vec3 Times(const Matrix3<double>& a, const Vec3& v) {
  return ToVec3(a * From<double>(v));
}
inline Vec3 TransposedTimes(const Matrix3<double>& a, const Vec3& v) {
  return ToVec3(Transposed(a) * From<double>(v));
}
/// a b.
inline Matrix3<double> Product(const Matrix3<double>& a, const Matrix3<double>& b) {
  Matrix3<double> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return c;
}

inline Vec3 ToWorld(const Pose& pose, const Vec3& local) {
  return Times(pose.rotation, local) + pose.position;
}
inline Vec3 ToLocal(const Pose& pose, const Vec3& world) {
  return TransposedTimes(pose.rotation, world - pose.position);
}

struct SinCos {
  double sin = 0, cos = 1;
};
/// Exact for quarter turns, and after many turns as good as in the first.
inline SinCos SinCosOf(double degrees) {
  int quarters = 0;
  const double rest = std::remquo(degrees, 90, &quarters) * (std::numbers::pi / 180);  // at most an eighth of a turn
  const double s = std::sin(rest), c = std::cos(rest);
  switch (quarters & 3) {
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    case 3:
      return {-c, s};
    default:
      return {s, c};
  }
}

/// Turns about an axis of length 1, counter-clockwise seen from its tip [degree]: Rodrigues' formula,
/// c I + s [a]ₓ + (1 - c) a aᵀ.
inline Matrix3<double> RotationAbout(const Vec3& axis, double degrees) {
  const auto [s, c] = SinCosOf(degrees);
  const Vector3<double> a = From<double>(axis);
  const Matrix3<double> cross{{0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0}};
  return Diagonal(c) + cross * s + Outer(a, a) * (1 - c);
}

/// Turns about x, then y, then z [degree].
inline Matrix3<double> RotationXyz(const Vec3& degrees) {
  return Product(RotationAbout({0, 0, 1}, degrees.z),
                 Product(RotationAbout({0, 1, 0}, degrees.y), RotationAbout({1, 0, 0}, degrees.x)));
}

/// The shortest turn that brings y to `direction`, of length 1.
inline Matrix3<double> RotationFromY(const Vec3& direction) {
  // I + [v]ₓ + [v]ₓ² / (1 + c) with v = y × n and c = y·n, for the n or -n that points up; then x and -x in one.
  const double flip = direction.y < 0 ? -1 : 1;
  const Vec3 n = direction * flip;
  const double k = 1 / (1 + n.y);
  Matrix3<double> turn{
      {1 - k * n.x * n.x, n.x, -k * n.x * n.z, -n.x, n.y, -n.z, -k * n.x * n.z, n.z, 1 - k * n.z * n.z}};
  for (int row = 0; row < 3; ++row) turn(row, 1) *= flip, turn(row, 2) *= flip;
  return turn;
}

/// What share of a motion from `start` to `end` [s] is done at `time`: at constant speed, or smoothly from rest to
/// rest.
inline double MotionShare(double start, double end, bool steady, double time) {
  const double s = std::clamp((time - start) / (end - start), 0.0, 1.0);
  return steady ? s : s * s * (3 - 2 * s);
}

}  // namespace percale
