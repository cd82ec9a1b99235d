#pragma once
/// \file
/// The energies of the continuum engine: each is the triple of value, gradient and second derivative, and each of the
/// latter is held against differences of the former.

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "math/splitmix64.h"
#include "math/vector3.h"
#include "tests/fabric/decompositions.h"

namespace percale::test {

using V = Vector3<double>;
using M = Matrix3<double>;
using Points = std::vector<V>;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kExact = 1e30;  // a floor that nothing is below
constexpr double kAgreement = 1e-6;
constexpr int kStates = 40;

inline double Within(SplitMix64& random, double low, double high) {
  return low + (high - low) * random.NextUnit();
}
inline V Jitter(SplitMix64& random, double size) {
  return {Within(random, -size, size), Within(random, -size, size), Within(random, -size, size)};
}
inline double Norm(const V& a) {
  return std::sqrt(Dot(a, a));
}
inline bool Finite(const V& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
template <class T>
bool Finite(const Matrix3<T>& a) {
  return std::all_of(a.m, a.m + 9, [](T value) { return std::isfinite(value); });
}

inline VectorXd Flat(const Points& x) {
  VectorXd flat(3 * static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    flat.segment<3>(3 * static_cast<Eigen::Index>(i)) << x[i].x, x[i].y, x[i].z;
  }
  return flat;
}
inline double& Coordinate(Points& x, Eigen::Index k) {
  V& point = x[static_cast<std::size_t>(k / 3)];
  return k % 3 == 0 ? point.x : k % 3 == 1 ? point.y : point.z;
}
inline Eigen::Matrix3d Dense(const M& a) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(a.m);
}
inline double LeastEigenvalue(const MatrixXd& a) {
  return SpectrumOf(a).values(0);
}

/// Central difference of fourth order.
template <class F>
auto Difference(const F& f, Points x, Eigen::Index k, double step) -> decltype(f(x)) {
  const double at = Coordinate(x, k);
  const auto value = [&](double offset) {
    Coordinate(x, k) = at + offset * step;
    return f(x);
  };
  return (8.0 * (value(1) - value(-1)) - (value(2) - value(-2))) / (12 * step);
}

using Value = std::function<double(const Points&)>;
using Gradient = std::function<VectorXd(const Points&)>;

inline void CheckGradient(const Value& value, const Gradient& gradient, const Points& x, double step) {
  const VectorXd g = gradient(x);
  VectorXd expected(g.size());
  for (Eigen::Index k = 0; k < g.size(); ++k) expected(k) = Difference(value, x, k, step);
  CHECK((g - expected).norm() <= kAgreement * (expected.norm() + 1e-9 / step * std::fabs(value(x))));
}
inline void CheckHessian(const Gradient& gradient, const MatrixXd& h, const Points& x, double step) {
  MatrixXd expected(h.rows(), h.cols());
  for (Eigen::Index k = 0; k < h.cols(); ++k) expected.col(k) = Difference(gradient, x, k, step);
  CHECK((h - expected).norm() <= kAgreement * expected.norm());
}
/// No net force and no net torque.
inline void CheckMomentum(const Points& x, const VectorXd& gradient) {
  V force{}, torque{};
  double scale = 0, lever = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const V g{gradient(k), gradient(k + 1), gradient(k + 2)};
    force += g;
    torque += Cross(x[i], g);
    scale += Norm(g);
    lever = std::max(lever, Norm(x[i]));
  }
  CHECK(Norm(force) <= 1e-12 * scale);
  CHECK(Norm(torque) <= 1e-12 * scale * lever);
}

/// Turns about an axis (Rodrigues) and shifts.
inline Points Moved(const Points& x, const V& axis, double angle, const V& shift) {
  const V k = axis * (1 / Norm(axis));
  Points moved;
  for (const V& p : x) {
    moved.push_back(p * std::cos(angle) + Cross(k, p) * std::sin(angle) + k * (Dot(k, p) * (1 - std::cos(angle))) +
                    shift);
  }
  return moved;
}

inline Points Anywhere(SplitMix64& random, std::size_t count) {
  Points x(count);
  for (V& p : x) p = Jitter(random, 1);
  return x;
}

/// Two numbers side by side: what an energy may use of a number, and no more.
struct Two {
  double a = 0, b = 0;
  Two() = default;
  explicit Two(double both) : a(both), b(both) {}
  Two(double first, double second) : a(first), b(second) {}
  Two& operator+=(Two o) { return *this = Two(a + o.a, b + o.b); }
  Two& operator-=(Two o) { return *this = Two(a - o.a, b - o.b); }
  friend Two operator+(Two x, Two y) { return {x.a + y.a, x.b + y.b}; }
  friend Two operator-(Two x, Two y) { return {x.a - y.a, x.b - y.b}; }
  friend Two operator-(Two x) { return {-x.a, -x.b}; }
  friend Two operator*(Two x, Two y) { return {x.a * y.a, x.b * y.b}; }
  friend Two operator/(Two x, Two y) { return {x.a / y.a, x.b / y.b}; }
};
struct TwoMask {
  bool a, b;
};
inline TwoMask operator>(Two x, Two y) {
  return {x.a > y.a, x.b > y.b};
}
inline Two Select(TwoMask m, Two x, Two y) {
  return {m.a ? x.a : y.a, m.b ? x.b : y.b};
}
inline Two Sqrt(Two x) {
  return {std::sqrt(x.a), std::sqrt(x.b)};
}
inline Two Atan2(Two y, Two x) {
  return {std::atan2(y.a, x.a), std::atan2(y.b, x.b)};
}
inline Vector3<Two> Pair(const V& a, const V& b) {
  return {{a.x, b.x}, {a.y, b.y}, {a.z, b.z}};
}
inline bool Same(const Vector3<Two>& both, const V& a, const V& b) {
  return both.x.a == a.x && both.y.a == a.y && both.z.a == a.z && both.x.b == b.x && both.y.b == b.y && both.z.b == b.z;
}
inline bool Same(const Matrix3<Two>& both, const M& a, const M& b) {
  bool same = true;
  for (int k = 0; k < 9; ++k) same = same && both.m[k].a == a.m[k] && both.m[k].b == b.m[k];
  return same;
}
inline Vector3<float> ToFloat(const V& a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
inline V ToDouble(const Vector3<float>& a) {
  return {a.x, a.y, a.z};
}

}  // namespace percale::test
