#include "render/mat4.h"

#include <cmath>

namespace percale {

Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 product;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      double sum = 0;
      for (int k = 0; k < 4; ++k) sum += a(row, k) * b(k, column);
      product(row, column) = sum;
    }
  }
  return product;
}

Vec3 TransformPoint(const Mat4& a, const Vec3& point) {
  const auto row = [&](int r) { return a(r, 0) * point.x + a(r, 1) * point.y + a(r, 2) * point.z + a(r, 3); };
  return Vec3{row(0), row(1), row(2)} / row(3);
}

Mat4 LookAt(const Vec3& eye, const Vec3& target, const Vec3& up) {
  const Vec3 back = UnitOr(eye - target, {0, 0, 1});
  const Vec3 right = UnitOr(Cross(up, back), {1, 0, 0});
  const Vec3 top = Cross(back, right);
  Mat4 view;
  const Vec3 rows[3] = {right, top, back};
  for (int r = 0; r < 3; ++r) {
    view(r, 0) = rows[r].x;
    view(r, 1) = rows[r].y;
    view(r, 2) = rows[r].z;
    view(r, 3) = -Dot(rows[r], eye);
  }
  return view;
}

Mat4 Perspective(double verticalAngle, double aspect, double nearPlane, double farPlane) {
  const double top = std::tan(verticalAngle / 2);
  Mat4 projection;
  projection(0, 0) = 1 / (top * aspect);
  projection(1, 1) = 1 / top;
  projection(2, 2) = -(farPlane + nearPlane) / (farPlane - nearPlane);
  projection(2, 3) = -2 * farPlane * nearPlane / (farPlane - nearPlane);
  projection(3, 2) = -1;
  projection(3, 3) = 0;
  return projection;
}

}  // namespace percale
