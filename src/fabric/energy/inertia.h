#pragma once
/// \file
/// The part of the incremental potential that is not a force: what it costs to end a step elsewhere than inertia leads.

#include "fabric/energy/number.h"
#include "fabric/energy/point_energy.h"
#include "math/vector3.h"

namespace percale::fabric {

/// ½ m |x - x̃|² / h², x̃ = x_start + h v + h² g the position without inner forces. `massPerSquare` is m/h² [kg/s²];
/// `offset` is x - x̃ [m], which the caller knows without taking the difference of two large coordinates.
template <class T>
PointEnergy<T> Inertia(T massPerSquare, const Vector3<T>& offset) {
  return {T(0.5) * massPerSquare * Dot(offset, offset), offset * massPerSquare, Diagonal(massPerSquare)};
}

}  // namespace percale::fabric
