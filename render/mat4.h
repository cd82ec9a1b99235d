#pragma once
/// \file
/// 4 x 4 matrices for drawing. Column vectors, column-major storage, as OpenGL has them.

#include <array>
#include <cstddef>

#include "percale/vec3.h"

namespace percale {

struct Mat4 {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0,
                           0, 0, 1, 0, 0, 0, 0, 1};  ///< Element (row, column) is m[4 * column + row].

  double operator()(int row, int column) const { return m[static_cast<std::size_t>(4 * column + row)]; }
  double& operator()(int row, int column) { return m[static_cast<std::size_t>(4 * column + row)]; }
};

Mat4 operator*(const Mat4& a, const Mat4& b);

/// (point, 1) transformed, and divided by the resulting w.
Vec3 TransformPoint(const Mat4& a, const Vec3& point);

/// Camera space from world space, for an eye that looks at `target`. `up` must not be parallel to the view.
Mat4 LookAt(const Vec3& eye, const Vec3& target, const Vec3& up);

/// Clip space from camera space. `verticalAngle` [rad], `aspect` = width / height, 0 < nearPlane < farPlane [m].
Mat4 Perspective(double verticalAngle, double aspect, double nearPlane, double farPlane);

}  // namespace percale
