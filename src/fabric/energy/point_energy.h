#pragma once
/// \file
/// What an energy of a single vertex gives.

#include "math/vector3.h"

namespace percale::fabric {

template <class T>
struct PointEnergy {
  T energy{};           ///< [J]
  Vector3<T> gradient;  ///< [N]; the force is its negative.
  Matrix3<T> hessian;   ///< [N/m], without negative eigenvalues.
};

}  // namespace percale::fabric
