#pragma once
/// \file
/// Air on a triangle: drag and lift of the wind, and the pressure of what it encloses.
///
/// The force of the wind on a plate of area A with unit normal n, for air that passes it at v, is
///   F = ½ ρ A |v| (c_n n nᵀ + c_t (1 - n nᵀ)) v + ½ ρ A c_l |v|² (n·v̂) (n - (n·v̂) v̂).
/// The first part is drag with the two coefficients of a plate faced and grazed: at incidence α, sin α = n·v̂, it is
/// c_t + (c_n - c_t) sin² α along v and already lifts with (c_n - c_t) sin α cos α across it. The second is lift on
/// top, perpendicular to v. Neither changes with the sign of n. (Wilson et al. 2014, "Simulating wind effects on cloth
/// and hair in Disney's Frozen", work with a drag and a lift coefficient per triangle.)
///
/// Explicit drag on light cloth is unstable. So |v| and n are taken at the start of the step, and the rest is left at
/// its end: then the drag is linear in the end's velocity, and the derivative of a quadratic energy.

#include "fabric/energy/number.h"
#include "math/vector3.h"

namespace percale::fabric {

/// Air as the cloth meets it.
template <class T>
struct Air {
  T density{};     ///< ρ [kg/m³]; 1.2 at 20 °C.
  T normal{};      ///< c_n >= 0, drag coefficient of a plate faced by the wind: about 1.2 (Hoerner 1965, "Fluid-dynamic
                   ///< drag").
  T tangential{};  ///< c_t >= 0, of a plate along the wind: skin friction, some 0.01.
  T lift{};        ///< c_l, besides what the difference of the two gives; 0 is a plate.
};

/// The wind on one triangle over one step.
template <class T>
struct WindLoad {
  Matrix3<T> drag;  ///< F = drag (wind - v̄) [kg/s]: symmetric, without negative eigenvalues.
  Vector3<T> wind;  ///< [m/s]
  Vector3<T> lift;  ///< [N], constant over the step.
};

/// From the corners at the start of the step and their mean velocity v̄ [m/s]. No area: no load.
template <class T>
WindLoad<T> MakeWindLoad(const Air<T>& air, const Vector3<T>& wind, const Vector3<T>& x0, const Vector3<T>& x1,
                         const Vector3<T>& x2, const Vector3<T>& meanVelocity) {
  const T half = T(0.5), one = T(1);
  const Vector3<T> cross = Cross(x1 - x0, x2 - x0), v = wind - meanVelocity;
  const T doubleArea = Sqrt(Dot(cross, cross)), speed = Sqrt(Dot(v, v));
  const Vector3<T> n = cross * (one / Greater(doubleArea, T(1e-18))), along = v * (one / Greater(speed, T(1e-18)));
  const T impulse = half * air.density * (half * doubleArea) * speed;
  const T incidence = Dot(n, along);
  return {Outer(n, n) * (impulse * (air.normal - air.tangential)) + Diagonal(impulse * air.tangential), wind,
          (n - along * incidence) * (impulse * speed * air.lift * incidence)};
}

/// Energy [J] whose derivative by the corners is minus the force on them.
template <class T>
struct WindEnergy {
  T energy{};
  Vector3<T> gradient;  ///< [N], the same for each corner.
  Matrix3<T> hessian;   ///< [N/m], the same block for each pair of corners; without negative eigenvalues.
};

/// h/2 (wind - v̄)ᵀ drag (wind - v̄) - lift·d̄, where v̄ = d̄/h and `displacement` d̄ [m] is the mean of the corners'
/// over the step so far; `h` [s].
template <class T>
WindEnergy<T> Wind(const WindLoad<T>& load, const Vector3<T>& displacement, T h) {
  const T third = T(1.0 / 3), perStep = T(1) / h;
  const Vector3<T> v = load.wind - displacement * perStep, drag = load.drag * v;
  return {T(0.5) * h * Dot(v, drag) - Dot(load.lift, displacement), (drag + load.lift) * -third,
          load.drag * (third * third * perStep)};
}

/// One triangle's part of the volume [m³] that a closed surface encloses, positive where normals point out:
/// x0·(x1 x x2)/6, and its derivatives by the corners [m²]. Times -p they are those of the energy -p V of a pressure p
/// [Pa]. Only the sum over a closed surface does not depend on the origin; take positions from a point nearby.
template <class T>
struct EnclosedVolume {
  T volume{};
  Vector3<T> gradient[3];
};

template <class T>
EnclosedVolume<T> Volume(const Vector3<T>& x0, const Vector3<T>& x1, const Vector3<T>& x2) {
  const T sixth = T(1.0 / 6);
  const Vector3<T> g0 = Cross(x1, x2) * sixth;
  return {Dot(x0, g0), {g0, Cross(x2, x0) * sixth, Cross(x0, x1) * sixth}};
}

}  // namespace percale::fabric
