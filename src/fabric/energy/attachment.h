#pragma once
/// \file
/// What holds a vertex to a place: a spring of no length, which a hand pulls with, and a tether.

#include "fabric/energy/number.h"
#include "fabric/energy/point_energy.h"
#include "math/vector3.h"

namespace percale::fabric {

/// ½ k |x - target|². `stiffness` k [N/m] >= 0.
template <class T>
PointEnergy<T> Handle(T stiffness, const Vector3<T>& target, const Vector3<T>& x) {
  const Vector3<T> d = x - target;
  return {T(0.5) * stiffness * Dot(d, d), d * stiffness, Diagonal(stiffness)};
}

/// ½ k max(0, |x - anchor| - length)²: slack up to `length` [m] >= 0, `stiffness` k [N/m] >= 0 beyond. The second
/// derivative is exact where it is taut: k n nᵀ + k (1 - length/|d|) (1 - n nᵀ). (Kim, Chentanez, Müller-Fischer 2012,
/// "Long range attachments", have such tethers as constraints.)
template <class T>
PointEnergy<T> TetherEnergy(T stiffness, const Vector3<T>& anchor, T length, const Vector3<T>& x) {
  const Vector3<T> d = x - anchor;
  const T distance = Sqrt(Dot(d, d));
  const Vector3<T> n = d * (T(1) / Greater(distance, T(1e-18)));
  const T beyond = PositivePart(distance - length);
  const T along = Select(beyond > T{}, stiffness, T{});
  const T across = stiffness * beyond / Greater(distance, T(1e-18));
  return {T(0.5) * stiffness * beyond * beyond, n * (stiffness * beyond),
          Outer(n, n) * (along - across) + Diagonal(across)};
}

}  // namespace percale::fabric
