#pragma once
/// \file
/// What the energies ask of a number T besides math/vector3.h, so that one text serves double, float and a few of them
/// side by side: T{} is zero, T(0.5) from a double; + - * / += -= and the sign; a > b that Select takes;
/// Select, Sqrt, and for angles Atan2, found next to T. No energy branches on a value.

#include <cmath>

#include "math/vector3.h"

namespace percale::fabric {

inline double Atan2(double y, double x) {
  return std::atan2(y, x);
}
inline float Atan2(float y, float x) {
  return std::atan2(y, x);
}

/// a where it is positive, else zero; zero where it is not a number.
template <class T>
T PositivePart(T a) {
  return Greater(a, T{});
}

/// A symmetric 2 x 2 matrix [[a, c], [c, b]].
template <class T>
struct Symmetric2 {
  T a, b, c;
};

/// The same with eigenvalues below -`floor` raised to it; floor >= 0. From mean and radius of the pair, so that equal
/// eigenvalues need no direction.
template <class T>
Symmetric2<T> ClampedEigenvalues(const Symmetric2<T>& s, T floor) {
  const T half = T(0.5);
  const T mean = half * (s.a + s.b), deviator = half * (s.a - s.b);
  const T radius = Sqrt(deviator * deviator + s.c * s.c);
  const T upper = Greater(mean + radius, -floor), lower = Greater(mean - radius, -floor);
  const T newMean = half * (upper + lower);
  const T scale = half * (upper - lower) / Greater(radius, T(1e-30));
  return {newMean + scale * deviator, newMean - scale * deviator, scale * s.c};
}

/// Where entry (row, column), row <= column, of a symmetric 6 x 6 matrix is among the 21 of its upper triangle, row by
/// row.
constexpr int Upper6(int row, int column) {
  return row * (11 - row) / 2 + column;
}

}  // namespace percale::fabric
