#pragma once
/// \file
/// In-plane elasticity of a triangle with linear displacements. Material coordinates [m]: u along the warp, v along the
/// weft. A law maps the two columns of the deformation gradient to energy per rest area [N/m], its derivatives and a
/// second derivative whose eigenvalues are bounded from below; the rest of the file carries these to the corners.
/// Thickness appears nowhere: stiffness is in N/m.

#include <cmath>

#include "fabric/energy/number.h"
#include "math/vector3.h"

namespace percale::fabric {

/// Where a corner lies in the cloth as it was cut [m].
struct MaterialPoint {
  double u = 0, v = 0;
};

/// What the rest shape contributes: the area [m²], and row by row the inverse [1/m] of the matrix whose columns are the
/// material edges p1 - p0 and p2 - p0.
template <class T>
struct RestTriangle {
  T area{};
  T inverse[4]{};
};

/// Of either orientation. A triangle without area has no stiffness either: all is zero.
template <class T = double>
RestTriangle<T> MakeRestTriangle(const MaterialPoint& p0, const MaterialPoint& p1, const MaterialPoint& p2) {
  const double u1 = p1.u - p0.u, v1 = p1.v - p0.v, u2 = p2.u - p0.u, v2 = p2.v - p0.v;
  const double det = u1 * v2 - u2 * v1, over = 1 / det;
  if (!std::isnormal(over) || !std::isnormal(det)) return {};
  return {T(0.5 * std::fabs(det)), {T(v2 * over), T(-u2 * over), T(-v1 * over), T(u1 * over)}};
}

/// dx/du and dx/dv; unit and orthogonal at rest.
template <class T>
struct DeformationGradient {
  Vector3<T> u, v;
};

template <class T>
DeformationGradient<T> Deformation(const RestTriangle<T>& rest, const Vector3<T>& x0, const Vector3<T>& x1,
                                   const Vector3<T>& x2) {
  const Vector3<T> e1 = x1 - x0, e2 = x2 - x0;
  return {e1 * rest.inverse[0] + e2 * rest.inverse[2], e1 * rest.inverse[1] + e2 * rest.inverse[3]};
}

/// The square of the larger singular value of F: how long the longest of all directions has become.
template <class T>
T SquaredStretch(const DeformationGradient<T>& f) {
  const T uu = Dot(f.u, f.u), vv = Dot(f.v, f.v), uv = Dot(f.u, f.v);
  return T(0.5) * (uu + vv) + Sqrt(T(0.25) * (uu - vv) * (uu - vv) + uv * uv);
}

/// Energy per area and its derivatives by fu and fv [N/m].
template <class T>
struct MembraneStress {
  T energy{};
  Vector3<T> pu, pv;
};

/// Second derivative [N/m] by (fu, fv), in blocks; vu is the transpose of uv.
template <class T>
struct MembraneTangent {
  Matrix3<T> uu, uv, vv;
};

/// Stress at which a plate buckles on its own inertia over a step, times the step: 2 sqrt(D rho) [N s/m]; 0 without
/// area. `stiffness`: D [N m]. `mass`: of a triangle's three corners, each of which has about two triangles [kg].
template <class T>
T BucklingStress(T stiffness, T mass, T area) {
  return Select(area > T{}, T(2) * Sqrt(stiffness * mass / (T(6) * area)), T{});
}

// --- Orthotropic St. Venant-Kirchhoff ---

/// W = ½ (c11 E11² + 2 c12 E11 E22 + c22 E22² + c33 γ²), with E11 = (fu·fu - 1)/2, E22 likewise and γ = fu·fv; beyond
/// a stated strain one-sidedly + k/3 (E - limit)³ for either direction, C² joined.
template <class T>
struct StVenantKirchhoff {
  T c11{}, c12{}, c22{}, c33{};            ///< [N/m]
  T limitU{}, limitV{};                    ///< Green strain above which the cubic acts: stretch λ has (λ² - 1)/2.
  T limitStiffnessU{}, limitStiffnessV{};  ///< k [N/m]; 0: no limit.
};

/// Green strains; `shear` is twice the off-diagonal one.
template <class T>
struct MembraneStrain {
  T e11{}, e22{}, shear{};
};

template <class T>
MembraneStrain<T> GreenStrain(const DeformationGradient<T>& f) {
  const T half = T(0.5), one = T(1);
  return {half * (Dot(f.u, f.u) - one), half * (Dot(f.v, f.v) - one), Dot(f.u, f.v)};
}

/// Rayleigh damping: W += (β/h)/2 (E - E0)ᵀ C (E - E0), whose derivative is C times β times the rate of strain over the
/// step. Strains do not see rigid motion, so neither does the damping; momentum, also angular, is conserved.
template <class T>
struct MembraneDamping {
  T rate{};                 ///< β/h, >= 0: time constant of the damping over the length of the step.
  MembraneStrain<T> start;  ///< E0, at the start of the step.
};

/// dW/dE, all parts of it.
template <class T>
struct MembraneForce {
  T energy{};
  T s1{}, s2{}, s3{};  ///< Second Piola-Kirchhoff stress 11, 22, 12 [N/m].
};

template <class T>
MembraneForce<T> SecondStress(const StVenantKirchhoff<T>& law, const MembraneStrain<T>& e,
                              const MembraneDamping<T>& damping = {}) {
  const T half = T(0.5), third = T(1.0 / 3);
  const T d1 = e.e11 - damping.start.e11, d2 = e.e22 - damping.start.e22, d3 = e.shear - damping.start.shear;
  const T s1 = law.c11 * e.e11 + law.c12 * e.e22, s2 = law.c12 * e.e11 + law.c22 * e.e22, s3 = law.c33 * e.shear;
  const T r1 = damping.rate * (law.c11 * d1 + law.c12 * d2), r2 = damping.rate * (law.c12 * d1 + law.c22 * d2),
          r3 = damping.rate * (law.c33 * d3);
  const T over1 = PositivePart(e.e11 - law.limitU), over2 = PositivePart(e.e22 - law.limitV);
  const T l1 = law.limitStiffnessU * over1 * over1, l2 = law.limitStiffnessV * over2 * over2;
  return {
      half * (s1 * e.e11 + s2 * e.e22 + s3 * e.shear + r1 * d1 + r2 * d2 + r3 * d3) + third * (l1 * over1 + l2 * over2),
      s1 + r1 + l1, s2 + r2 + l2, s3 + r3};
}

template <class T>
MembraneStress<T> Stress(const StVenantKirchhoff<T>& law, const DeformationGradient<T>& f,
                         const MembraneDamping<T>& damping = {}) {
  const MembraneForce<T> s = SecondStress(law, GreenStrain(f), damping);
  return {s.energy, f.u * s.s1 + f.v * s.s3, f.u * s.s3 + f.v * s.s2};
}

/// Σ C_kl j_k j_lᵀ + S x I3, where j_k is the derivative of strain k by (fu, fv) and the eigenvalues of the stress S
/// are raised to at least -`floor` [N/m]. The first sum has no negative eigenvalue where C has none, so at floor 0
/// neither has the whole; a large floor gives the exact second derivative.
template <class T>
MembraneTangent<T> Tangent(const StVenantKirchhoff<T>& law, const DeformationGradient<T>& f, T floor,
                           const MembraneDamping<T>& damping = {}) {
  const MembraneStrain<T> e = GreenStrain(f);
  const MembraneForce<T> force = SecondStress(law, e, damping);
  const Symmetric2<T> s = ClampedEigenvalues<T>({force.s1, force.s2, force.s3}, floor);
  const T two = T(2), damped = T(1) + damping.rate;
  const T c11 = damped * law.c11 + two * law.limitStiffnessU * PositivePart(e.e11 - law.limitU);
  const T c22 = damped * law.c22 + two * law.limitStiffnessV * PositivePart(e.e22 - law.limitV);
  const T c12 = damped * law.c12, c33 = damped * law.c33;
  const Matrix3<T> uu = Outer(f.u, f.u), uv = Outer(f.u, f.v), vv = Outer(f.v, f.v);
  return {uu * c11 + vv * c33 + Diagonal(s.a), uv * c12 + Transposed(uv) * c33 + Diagonal(s.c),
          vv * c22 + uu * c33 + Diagonal(s.b)};
}

/// From what a strip test measures: `warp` and `weft` [N/m], force per width over strain of a strip cut along u and
/// along v; `poisson`, contraction along v per extension along u of the strip along u; `shear` [N/m].
inline StVenantKirchhoff<double> OrthotropicMembrane(double warp, double weft, double poisson, double shear) {
  const double other = poisson * weft / warp;  // the compliance is symmetric: ν_vu / E_v = ν_uv / E_u
  const double scale = 1 / (1 - poisson * other);
  return {.c11 = warp * scale, .c12 = poisson * weft * scale, .c22 = weft * scale, .c33 = shear};
}

/// `stiffness` K [N/m] is that of a strip: Young's modulus times thickness. -1 < poisson < 1.
inline StVenantKirchhoff<double> IsotropicMembrane(double stiffness, double poisson) {
  return OrthotropicMembrane(stiffness, stiffness, poisson, stiffness / (2 * (1 + poisson)));
}

/// Whether every strain costs energy; else the cloth has no rest shape, and no tangent is safe.
inline bool IsPositiveDefinite(const StVenantKirchhoff<double>& law) {
  return law.c11 > 0 && law.c33 > 0 && law.c11 * law.c22 - law.c12 * law.c12 > 0;
}

/// Force per width over strain [N/m], for small strain, of a strip cut at `angle` [rad] from the warp: 1/K(angle) is
/// the compliance S = C⁻¹ turned, S11 c⁴ + (2 S12 + S33) c² s² + S22 s⁴ (Jones 1999, "Mechanics of composite
/// materials", chapter 2).
inline double StripStiffness(const StVenantKirchhoff<double>& law, double angle) {
  const double det = law.c11 * law.c22 - law.c12 * law.c12;
  const double c = std::cos(angle), s = std::sin(angle), cc = c * c, ss = s * s;
  return 1 / (law.c22 / det * cc * cc + (1 / law.c33 - 2 * law.c12 / det) * cc * ss + law.c11 / det * ss * ss);
}

// --- Stable neo-Hookean ---

/// W = μ/2 (fu·fu + fv·fv - 2) - μ (J - 1) + λ'/2 (J - 1)², J = |fu x fv| the ratio of areas: the law of Smith, De Goes
/// and Kim 2018 ("Stable neo-Hookean flesh simulation") in two dimensions, where λ' = λ + μ makes it agree with
/// linear elasticity at small strain. It resists collapse with finite force; a surface in space cannot invert.
template <class T>
struct StableNeoHookean {
  T mu{};           ///< μ [N/m].
  T lambdaPrime{};  ///< λ' = λ + μ [N/m].
};

/// With the same small-strain response as IsotropicMembrane.
inline StableNeoHookean<double> NeoHookeanMembrane(double stiffness, double poisson) {
  return {stiffness / (2 * (1 + poisson)), stiffness / (2 * (1 - poisson))};
}

/// Ratio of areas below which a triangle is taken to have no normal. In float the normal is noise from about 1e-7 on.
constexpr double kLeastAreaRatio = 1e-6;

template <class T>
MembraneStress<T> Stress(const StableNeoHookean<T>& law, const DeformationGradient<T>& f) {
  const T half = T(0.5), one = T(1);
  const Vector3<T> cross = Cross(f.u, f.v);
  const T area = Sqrt(Dot(cross, cross)), excess = area - one;
  const Vector3<T> normal = cross * (one / Greater(area, T(kLeastAreaRatio)));  // fades where there is none
  const T pressure = law.lambdaPrime * excess - law.mu;                         // dW/dJ, = λ' (J - α)
  return {
      half * law.mu * (Dot(f.u, f.u) - one + Dot(f.v, f.v) - one) + excess * (half * law.lambdaPrime * excess - law.mu),
      f.u * law.mu + Cross(f.v, normal) * pressure, f.v * law.mu + Cross(normal, f.u) * pressure};
}

/// Second derivative with eigenvalues raised to at least -`floor` [N/m]; a large floor gives the exact one.
/// Derivation, after Smith, De Goes and Kim 2019 ("Analytic eigensystems for isotropic distortion energies"), without
/// the singular value decomposition. With f = (fu, fv), p = dW/dJ and g = dJ/df it is μ I + λ' g gᵀ + p d²J/df².
/// In the plane of the triangle J is the determinant, a quadratic form: d²J/df² = D there, D² = 1, D (fu, fv) =
/// (fv x n, n x fu) = g. So D has eigenvalues +1 (two: twist and equal scaling) and -1 (two), f± = (f ± D f)/2 are the
/// parts of f in either, and g = f+ - f-. Only the plane (f+, f-) couples, in a 2 x 2 matrix; orthogonal to it the
/// eigenvalues are μ + p and μ - p. Along n the second derivative of J is adj(FᵀF)/J: another 2 x 2 matrix.
/// Any unit n gives a matrix so bounded, so where the triangle has no normal any will do.
template <class T>
MembraneTangent<T> Tangent(const StableNeoHookean<T>& law, const DeformationGradient<T>& f, T floor) {
  const T half = T(0.5), zero = T{}, one = T(1), least = T(kLeastAreaRatio);
  const Vector3<T> cross = Cross(f.u, f.v);
  const T area = Sqrt(Dot(cross, cross)), inverse = one / Greater(area, least);
  const auto flat = area > least;
  const Vector3<T> n{Select(flat, cross.x * inverse, zero), Select(flat, cross.y * inverse, zero),
                     Select(flat, cross.z * inverse, one)};
  const T p = law.lambdaPrime * (area - one) - law.mu;

  const Vector3<T> inU = f.u - n * Dot(n, f.u), inV = f.v - n * Dot(n, f.v);
  const Vector3<T> gu = Cross(f.v, n), gv = Cross(n, f.u);
  Vector3<T> plusU = (inU + gu) * half, plusV = (inV + gv) * half;
  Vector3<T> minusU = (inU - gu) * half, minusV = (inV - gv) * half;
  const T plus = Sqrt(Dot(plusU, plusU) + Dot(plusV, plusV)), minus = Sqrt(Dot(minusU, minusU) + Dot(minusV, minusV));
  const T perPlus = one / Greater(plus, T(1e-15)), perMinus = one / Greater(minus, T(1e-15));
  plusU = plusU * perPlus, plusV = plusV * perPlus, minusU = minusU * perMinus, minusV = minusV * perMinus;

  const T lambda = law.lambdaPrime;
  const T twist = Greater(law.mu + p, -floor), flip = Greater(law.mu - p, -floor);
  const Symmetric2<T> scaling = ClampedEigenvalues<T>(
      {law.mu + p + lambda * plus * plus, law.mu - p + lambda * minus * minus, -lambda * plus * minus}, floor);
  const T byArea = p * inverse;
  const Symmetric2<T> across = ClampedEigenvalues<T>(
      {law.mu + byArea * Dot(f.v, f.v), law.mu + byArea * Dot(f.u, f.u), -byArea * Dot(f.u, f.v)}, floor);

  // twist P+ + flip P-, with P± = ((1 - n nᵀ) ± D)/2 and D_uv w = w x n.
  const T mean = half * (twist + flip), spin = half * (twist - flip);
  const Matrix3<T> nn = Outer(n, n);
  const Matrix3<T> crossN{
      {zero, n.z * spin, -n.y * spin, -n.z * spin, zero, n.x * spin, n.y * spin, -n.x * spin, zero}};
  const Matrix3<T> diagonal = Diagonal(mean);
  MembraneTangent<T> h{diagonal + nn * (across.a - mean), crossN + nn * across.c, diagonal + nn * (across.b - mean)};
  // What the plane (f+, f-) differs from that.
  const T a = scaling.a - twist, b = scaling.b - flip, c = scaling.c;
  const Vector3<T> au = plusU * a + minusU * c, av = plusV * a + minusV * c;
  const Vector3<T> bu = plusU * c + minusU * b, bv = plusV * c + minusV * b;
  h.uu += Outer(plusU, au) + Outer(minusU, bu);
  h.uv += Outer(plusU, av) + Outer(minusU, bv);
  h.vv += Outer(plusV, av) + Outer(minusV, bv);
  return h;
}

// --- To the corners ---

/// Derivative of a triangle's energy [J] by its corners [N]; the force is its negative.
template <class T>
struct TriangleGradient {
  Vector3<T> corner[3];
};

/// Second derivative [N/m]: block (k, k) and block (k, k + 1 modulo 3). The others are transposes.
template <class T>
struct TriangleHessian {
  Matrix3<T> diagonal[3];
  Matrix3<T> next[3];
};

/// The part of each corner in fu and fv [1/m]: fu = Σ u_i x_i.
template <class T>
struct CornerWeights {
  T u[3], v[3];
};
template <class T>
CornerWeights<T> WeightsOfCorners(const RestTriangle<T>& rest) {
  const T* q = rest.inverse;
  return {{-(q[0] + q[2]), q[0], q[2]}, {-(q[1] + q[3]), q[1], q[3]}};
}

template <class T>
TriangleGradient<T> CornerGradient(const RestTriangle<T>& rest, const MembraneStress<T>& stress) {
  const Vector3<T> pu = stress.pu * rest.area, pv = stress.pv * rest.area;
  const Vector3<T> g1 = pu * rest.inverse[0] + pv * rest.inverse[1], g2 = pu * rest.inverse[2] + pv * rest.inverse[3];
  return {{-(g1 + g2), g1, g2}};
}

template <class T>
TriangleHessian<T> CornerHessian(const RestTriangle<T>& rest, const MembraneTangent<T>& tangent) {
  const CornerWeights<T> w = WeightsOfCorners(rest);
  const Matrix3<T> vu = Transposed(tangent.uv);
  TriangleHessian<T> h;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    const T mixed = rest.area * w.u[k] * w.v[k];
    h.diagonal[k] = tangent.uu * (rest.area * w.u[k] * w.u[k]) + (tangent.uv + vu) * mixed +
                    tangent.vv * (rest.area * w.v[k] * w.v[k]);
    h.next[k] = tangent.uu * (rest.area * w.u[k] * w.u[l]) + tangent.uv * (rest.area * w.u[k] * w.v[l]) +
                vu * (rest.area * w.v[k] * w.u[l]) + tangent.vv * (rest.area * w.v[k] * w.v[l]);
  }
  return h;
}

}  // namespace percale::fabric
