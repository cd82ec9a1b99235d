#pragma once
/// \file
/// Vectors and matrices of three, over any kind of number: double, float, or a few of them side by side. The public
/// percale::Vec3 is what callers see; this is what kernels compute with.

#include <cmath>

#include "percale/vec3.h"

namespace percale {

// What an expression may ask of a number, so that it reads the same for one and for several side by side.

inline double Select(bool condition, double a, double b) {
  return condition ? a : b;
}
inline float Select(bool condition, float a, float b) {
  return condition ? a : b;
}
inline double Sqrt(double a) {
  return std::sqrt(a);
}
inline float Sqrt(float a) {
  return std::sqrt(a);
}
/// The greater and the lesser; `b` where one is not a number.
template <class T>
T Greater(T a, T b) {
  return Select(a > b, a, b);
}
template <class T>
T Lesser(T a, T b) {
  return Select(b > a, a, b);
}

template <class T>
struct Vector3 {
  T x{}, y{}, z{};

  Vector3& operator+=(const Vector3& o) {
    x += o.x, y += o.y, z += o.z;
    return *this;
  }
  Vector3& operator-=(const Vector3& o) {
    x -= o.x, y -= o.y, z -= o.z;
    return *this;
  }
  friend Vector3 operator+(Vector3 a, const Vector3& b) { return a += b; }
  friend Vector3 operator-(Vector3 a, const Vector3& b) { return a -= b; }
  friend Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
  friend Vector3 operator*(const Vector3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vector3 operator*(T s, const Vector3& a) { return {a.x * s, a.y * s, a.z * s}; }
};

template <class T>
Vector3<T> From(const Vec3& v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}
inline Vec3 ToVec3(const Vector3<double>& v) {
  return {v.x, v.y, v.z};
}
template <class T>
T Dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vector3<T> Cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Of 3 x 3, row by row.
template <class T>
struct Matrix3 {
  T m[9]{};

  T& operator()(int row, int column) { return m[3 * row + column]; }
  const T& operator()(int row, int column) const { return m[3 * row + column]; }
  Matrix3& operator+=(const Matrix3& o) {
    for (int k = 0; k < 9; ++k) m[k] += o.m[k];
    return *this;
  }
  friend Matrix3 operator+(Matrix3 a, const Matrix3& b) { return a += b; }
  friend Matrix3 operator*(const Matrix3& a, T s) {
    Matrix3 b;
    for (int k = 0; k < 9; ++k) b.m[k] = a.m[k] * s;
    return b;
  }
  friend Vector3<T> operator*(const Matrix3& a, const Vector3<T>& v) {
    return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
            a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
  }
};

/// Of 3 x 3.
template <class T>
struct SymmetricMatrix3 {
  T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

  SymmetricMatrix3& operator+=(const SymmetricMatrix3& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    return *this;
  }
  friend Vector3<T> operator*(const SymmetricMatrix3& a, const Vector3<T>& v) {
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.xz * v.x + a.yz * v.y + a.zz * v.z};
  }
  Matrix3<T> Full() const { return {{xx, xy, xz, xy, yy, yz, xz, yz, zz}}; }
};

template <class T>
Matrix3<T> Transposed(const Matrix3<T>& a) {
  return {{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}};
}
/// a bᵀ.
template <class T>
Matrix3<T> Outer(const Vector3<T>& a, const Vector3<T>& b) {
  return {{a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z}};
}
/// s on the diagonal.
template <class T>
Matrix3<T> Diagonal(T s) {
  const T zero = s - s;
  return {{s, zero, zero, zero, s, zero, zero, zero, s}};
}

}  // namespace percale
