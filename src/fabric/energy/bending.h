#pragma once
/// \file
/// Bending. The angles at the three edges of a triangle give its curvature, and the curvature a plate's energy:
///
///   K_T = Σ_i θ_i |e_i| / (A_T + A_i) n_i n_iᵀ,   κ = (K11, K22, 2 K12) = G θ,   E_T = ½ A_T κᵀ B κ = ½ θᵀ M_T θ.
///
/// θ_i is the angle at edge i, n_i the edge's unit normal in material coordinates, A_i the area of the triangle across.
/// Derivation: the slope of a piecewise linear surface jumps by θ_i n_i at the edge, so its second derivative is
/// θ_i n_i n_iᵀ times the edge's line measure. The share A_T/(A_T + A_i) of it belongs to T; over A_T, that is K_T. It
/// is exact for quadratic surfaces on any lattice of triangles. There a triangle's neighbour is its point reflection,
/// which makes θ_i = -e_jᵀ K e_k / h_i, h_i the height on edge i: K_T = -Σ_i (e_jᵀ K e_k) n_i n_iᵀ / h_i². Between two
/// edges, with n_i·e_j = ±h_i and Σ e_i = 0, that is K.
///
/// Why not a hinge alone, E = ½ D 3|e|²/(A1 + A2) θ² (Grinspun et al. 2003; Bridson et al. 2003 alike)? Take a square
/// grid of right triangles with legs h, and w = ½ κ x². The edges along y have θ = κ h, all others 0; there is one per
/// h², with A1 + A2 = h²: 3/2 D κ² per area, three times the plate's ½ D κ². Bent along the diagonal edges, w = ½ κ d²,
/// the legs have κ h each and the diagonal -κ h/√2: 9/2 D κ². So the stiffness depends on the direction of the mesh,
/// and a sum of squares of single angles has no place for Poisson's ratio, which multiplies K11 K22.
///
/// Elsewhere the energy is that of a surface with noise on its curvature, hence above the plate's, and finer meshes of
/// the kind do not lessen it: for them there is MakeFittedBendingMatrix, of the same form.
///
/// A boundary edge, or one with more than two triangles, has no angle. What it would be is left free: it is minimised
/// out of E_T (the Schur complement), which is the natural boundary condition, no moment across a free edge.

#include <cmath>

#include "fabric/energy/membrane.h"
#include "fabric/energy/number.h"
#include "math/vector3.h"

namespace percale::fabric {

/// B [N·m]: moments per length from curvatures (K11, K22, 2 K12).
struct BendingStiffness {
  double b11 = 0, b12 = 0, b22 = 0, b33 = 0;
};

/// `rigidity` D [N·m] is that of a plate, E t³ / (12 (1 - ν²)); a narrow strip of it bends with D (1 - ν²).
inline BendingStiffness IsotropicBending(double rigidity, double poisson) {
  return {rigidity, poisson * rigidity, rigidity, 0.5 * (1 - poisson) * rigidity};
}

/// From what a strip test measures, moment per width over curvature [N·m]: of strips along u and v; `poisson`,
/// curvature across per curvature along, of the strip along u; `twist`, which is strip / (2 (1 + ν)) where isotropic.
inline BendingStiffness OrthotropicBending(double warp, double weft, double poisson, double twist) {
  const double scale = 1 / (1 - poisson * poisson * weft / warp);
  return {warp * scale, poisson * weft * scale, weft * scale, twist};
}

inline bool IsPositiveDefinite(const BendingStiffness& b) {
  return b.b11 > 0 && b.b33 > 0 && b.b11 * b.b22 - b.b12 * b.b12 > 0;
}

/// A number for each edge of a triangle: edge k is opposite to corner k, from corner k + 1 to k + 2 (modulo 3).
template <class T>
struct EdgeAngles {
  T edge[3]{};
};

/// M_T [N·m], symmetric: entries (k, k) and (k, k + 1 modulo 3).
template <class T>
struct BendingMatrix {
  T diagonal[3]{};
  T next[3]{};
};

/// Of two triangles at an edge, the least area as a part of the edge's length squared: thinner pairs bend as if they
/// had it, so that slivers do not stiffen the sheet without bound. Two equilateral ones have 0.87.
constexpr double kLeastPairArea = 0.01;

/// `areaAcross[k]` [m²] is the area of the triangle across edge k; 0 where there is none, and its row is then zero.
template <class T = double>
BendingMatrix<T> MakeBendingMatrix(const BendingStiffness& b, const MaterialPoint (&p)[3],
                                   const double (&areaAcross)[3]) {
  const double area = 0.5 * std::fabs((p[1].u - p[0].u) * (p[2].v - p[0].v) - (p[2].u - p[0].u) * (p[1].v - p[0].v));
  double g[3][3] = {}, bg[3][3], m[3][3];
  for (int k = 0; k < 3; ++k) {
    const MaterialPoint &from = p[(k + 1) % 3], &to = p[(k + 2) % 3];
    const double du = to.u - from.u, dv = to.v - from.v, length = std::sqrt(du * du + dv * dv);
    if (!(area > 0) || !(length > 0)) continue;
    const double weight = 1 / (length * std::fmax(area + areaAcross[k], kLeastPairArea * length * length));
    g[0][k] = weight * dv * dv, g[1][k] = weight * du * du, g[2][k] = -2 * weight * du * dv;
  }
  for (int k = 0; k < 3; ++k) {
    bg[0][k] = b.b11 * g[0][k] + b.b12 * g[1][k];
    bg[1][k] = b.b12 * g[0][k] + b.b22 * g[1][k];
    bg[2][k] = b.b33 * g[2][k];
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m[i][j] = area * (g[0][i] * bg[0][j] + g[1][i] * bg[1][j] + g[2][i] * bg[2][j]);
  }
  const double trace = m[0][0] + m[1][1] + m[2][2];
  for (int k = 0; k < 3; ++k) {
    if (areaAcross[k] > 0) continue;
    // One step of elimination. A pivot of rounding only has nothing left to give: that of the third free edge, or of
    // the second one where the sheet bends in one direction alone.
    const double pivot = m[k][k];
    const double row[3] = {m[k][0], m[k][1], m[k][2]};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (pivot > 1e-12 * trace) m[i][j] -= row[i] * row[j] / pivot;
        if (i == k || j == k) m[i][j] = 0;
      }
    }
  }
  BendingMatrix<T> result;
  for (int k = 0; k < 3; ++k) result.diagonal[k] = T(m[k][k]), result.next[k] = T(m[k][(k + 1) % 3]);
  return result;
}

template <class T>
EdgeAngles<T> operator*(const BendingMatrix<T>& m, const EdgeAngles<T>& a) {
  const T *d = m.diagonal, *n = m.next, *e = a.edge;
  return {{d[0] * e[0] + n[0] * e[1] + n[2] * e[2], n[0] * e[0] + d[1] * e[1] + n[1] * e[2],
           n[2] * e[0] + n[1] * e[1] + d[2] * e[2]}};
}

/// Rayleigh damping: E += (β/h)/2 (θ - θ0)ᵀ M (θ - θ0). Angles do not see rigid motion.
template <class T>
struct BendingDamping {
  T rate{};             ///< β/h, >= 0: time constant of the damping over the length of the step.
  EdgeAngles<T> start;  ///< θ0, at the start of the step.
};

/// Energy [J] and its derivative by the angles [N·m].
template <class T>
struct BendingMoments {
  T energy{};
  EdgeAngles<T> moment;
};

/// Of one triangle, for angles at rest `rest`. The moment of a hinge is the sum of what its two triangles give.
template <class T>
BendingMoments<T> Moments(const BendingMatrix<T>& m, const EdgeAngles<T>& angle, const EdgeAngles<T>& rest,
                          const BendingDamping<T>& damping = {}) {
  EdgeAngles<T> bent, turned;
  for (int k = 0; k < 3; ++k) {
    bent.edge[k] = angle.edge[k] - rest.edge[k];
    turned.edge[k] = angle.edge[k] - damping.start.edge[k];
  }
  const EdgeAngles<T> elastic = m * bent, viscous = m * turned;
  BendingMoments<T> result;
  for (int k = 0; k < 3; ++k) {
    result.moment.edge[k] = elastic.edge[k] + damping.rate * viscous.edge[k];
    result.energy += T(0.5) * (elastic.edge[k] * bent.edge[k] + damping.rate * (viscous.edge[k] * turned.edge[k]));
  }
  return result;
}

// --- Angles ---

/// Angle at the edge x0-x1 between triangles (x0, x1, x2) and (x1, x0, x3), in (-π, π] [rad]: zero where flat, positive
/// in a valley, seen from the side of the normals; θ times the edge's normal is then the jump of slope. It wraps where
/// the triangles fold onto each other. Degenerate triangles give a finite angle.
template <class T>
T HingeAngle(const Vector3<T>& x0, const Vector3<T>& x1, const Vector3<T>& x2, const Vector3<T>& x3) {
  const Vector3<T> e = x1 - x0, d3 = x3 - x0;
  const Vector3<T> n1 = Cross(e, x2 - x0), n2 = Cross(d3, e);
  return Atan2(Sqrt(Dot(e, e)) * Dot(n1, d3), Dot(n1, n2));  // n2 x n1 = e (d3·n1)
}

/// An angle and its derivatives by x0 .. x3 [rad/m].
template <class T>
struct Hinge {
  T angle{};
  Vector3<T> gradient[4];
};

/// Height of a triangle over its hinge, as a part of the hinge's length, below which the derivative grows no more: in
/// float the normal of a thinner one is noise, and its push would be without bound.
constexpr double kLeastHeight = 1e-5;

/// x2 moves the angle by its height's inverse along the normal; the edge's ends balance it at the foot of the height.
/// (Bridson, Marino, Fedkiw 2003; Tamstorf and Grinspun 2013, "Discrete bending forces and their Jacobians".)
template <class T>
Hinge<T> HingeGradient(const Vector3<T>& x0, const Vector3<T>& x1, const Vector3<T>& x2, const Vector3<T>& x3) {
  const Vector3<T> e = x1 - x0, d2 = x2 - x0, d3 = x3 - x0;
  const Vector3<T> n1 = Cross(e, d2), n2 = Cross(d3, e);
  const T ee = Dot(e, e), length = Sqrt(ee), one = T(1);
  const T least = Greater(T(kLeastHeight * kLeastHeight) * ee * ee, T(1e-36));
  const Vector3<T> g2 = n1 * (length / Greater(Dot(n1, n1), least)), g3 = n2 * (length / Greater(Dot(n2, n2), least));
  const T perSquare = one / Greater(ee, T(1e-30));
  const T foot2 = Dot(d2, e) * perSquare, foot3 = Dot(d3, e) * perSquare;
  const Vector3<T> g1 = -(g2 * foot2 + g3 * foot3);
  return {Atan2(length * Dot(n1, d3), Dot(n1, n2)), {-(g1 + g2 + g3), g1, g2, g3}};
}

/// The same hinge as its second triangle has it: (x1, x0, x3, x2).
template <class T>
Hinge<T> FromAcross(const Hinge<T>& h) {
  return {h.angle, {h.gradient[1], h.gradient[0], h.gradient[3], h.gradient[2]}};
}

/// Second derivative by the six vertices of a triangle and its surroundings: corners 0, 1, 2, and vertex 3 + k across
/// edge k. Block (i, j), i <= j, is block[Upper6(i, j)]; the others are transposes.
template <class T>
struct BendingHessian {
  Matrix3<T> block[21];
};

/// Gauss-Newton: Σ M_ab ∇θ_a ∇θ_bᵀ, which has no negative eigenvalue and is exact where there is no moment. `hinge[k]`
/// is that of edge k as HingeGradient(corner k + 1, corner k + 2, corner k, vertex 3 + k) gives it; where there is
/// none, any finite one. With damping, scale by 1 + rate.
template <class T>
BendingHessian<T> GaussNewton(const BendingMatrix<T>& m, const Hinge<T> (&hinge)[3]) {
  Vector3<T> d[3][6];   // ∇θ_a by vertex
  Vector3<T> md[3][6];  // M times that
  for (int a = 0; a < 3; ++a) {
    const Vector3<T>* g = hinge[a].gradient;
    d[a][(a + 1) % 3] = g[0], d[a][(a + 2) % 3] = g[1], d[a][a] = g[2], d[a][3 + a] = g[3];
  }
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const T ab = m.next[a], ac = m.next[c];
    for (int i = 0; i < 3; ++i) md[a][i] = d[a][i] * m.diagonal[a] + d[b][i] * ab + d[c][i] * ac;
    md[a][3 + a] = d[a][3 + a] * m.diagonal[a];
    md[a][3 + b] = d[b][3 + b] * ab;
    md[a][3 + c] = d[c][3 + c] * ac;
  }
  BendingHessian<T> h;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      Matrix3<T>& block = h.block[Upper6(i, j)];
      if (i >= 3) {  // one angle only depends on a vertex across
        block = Outer(d[i - 3][i], md[i - 3][j]);
      } else {
        block = Outer(d[0][i], md[0][j]) + Outer(d[1][i], md[1][j]) + Outer(d[2][i], md[2][j]);
      }
    }
  }
  return h;
}

// --- Quadratic ---

/// ϑ = Σ c_i x_i [1/m] is the jump of the slope of the embedding across a hinge: a vector of length 2 sin(θ/2) while
/// the hinge is not stretched, and zero for any affine image of the flat one. With it in place of the angle the energy
/// is quadratic and its second derivative a constant scalar matrix times I3 (Bergou et al. 2006, "A quadratic bending
/// model for inextensible surfaces"; Wardetzky et al. 2007, "Discrete quadratic curvature energies"). A rest angle
/// other than zero has no place in it, and neither has damping of angles.
template <class T>
struct HingeWeights {
  T vertex[4]{};  ///< c_0 .. c_3 [1/m], in the order of HingeAngle.
};

/// From rest positions [m], unfolded or not: each side needs its own triangle's shape only.
template <class T = double>
HingeWeights<T> MakeHingeWeights(const Vector3<double>& x0, const Vector3<double>& x1, const Vector3<double>& x2,
                                 const Vector3<double>& x3) {
  const Vector3<double> e = x1 - x0;
  const double ee = Dot(e, e);
  if (!(ee > 0)) return {};
  double c[4] = {};
  for (int side = 2; side < 4; ++side) {
    const Vector3<double> d = (side == 2 ? x2 : x3) - x0, n = Cross(e, d);
    const double height = std::fmax(Sqrt(Dot(n, n) / ee), kLeastHeight * Sqrt(ee)), foot = Dot(d, e) / ee;
    c[side] = 1 / height;
    c[0] -= (1 - foot) / height;
    c[1] -= foot / height;
  }
  return {{T(c[0]), T(c[1]), T(c[2]), T(c[3])}};
}

// --- Irregular meshes ---

/// The apex of a triangle across an edge, unfolded into our panel, where the two have material coordinates of their
/// own, as at a seam. `from`, `to`, `corner` are ours; the others are its own, in the same order.
inline MaterialPoint UnfoldedApex(const MaterialPoint& from, const MaterialPoint& to, const MaterialPoint& corner,
                                  const MaterialPoint& itsFrom, const MaterialPoint& itsTo,
                                  const MaterialPoint& itsApex) {
  const double du = to.u - from.u, dv = to.v - from.v, eu = itsTo.u - itsFrom.u, ev = itsTo.v - itsFrom.v;
  const double au = itsApex.u - itsFrom.u, av = itsApex.v - itsFrom.v, square = eu * eu + ev * ev;
  if (!(square > 0)) return from;
  const double side = du * (corner.v - from.v) - dv * (corner.u - from.u) > 0 ? -1 : 1;
  const double foot = (au * eu + av * ev) / square, height = side * std::fabs(eu * av - ev * au) / square;
  return {from.u + foot * du - height * dv, from.v + foot * dv + height * du};
}

namespace detail {

/// Inverse of a symmetric 3 x 3 matrix without negative eigenvalues, its own eigenvalues at most `cap`. Cyclic Jacobi.
inline void CappedInverse(double (&a)[3][3], double cap) {
  double q[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int turn = 0; turn < 24; ++turn) {
    const int i = turn % 3, j = (i + 1) % 3;
    if (a[i][j] == 0) continue;
    const double ratio = (a[j][j] - a[i][i]) / (2 * a[i][j]);  // the smaller of two angles, or it need not converge
    const double tangent = std::copysign(1 / (std::fabs(ratio) + std::sqrt(1 + ratio * ratio)), ratio);
    const double c = 1 / std::sqrt(1 + tangent * tangent), s = tangent * c;
    for (int k = 0; k < 3; ++k) {
      const double x = a[k][i], y = a[k][j], u = q[k][i], v = q[k][j];
      a[k][i] = c * x - s * y, a[k][j] = s * x + c * y, q[k][i] = c * u - s * v, q[k][j] = s * u + c * v;
    }
    for (int k = 0; k < 3; ++k) {
      const double x = a[i][k], y = a[j][k];
      a[i][k] = c * x - s * y, a[j][k] = s * x + c * y;
    }
  }
  const double inverse[3] = {1 / std::fmax(a[0][0], 1 / cap), 1 / std::fmax(a[1][1], 1 / cap),
                             1 / std::fmax(a[2][2], 1 / cap)};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      a[i][j] = 0;
      for (int k = 0; k < 3; ++k) a[i][j] += q[i][k] * inverse[k] * q[j][k];
    }
  }
}

}  // namespace detail

/// How much stiffer than by the areas, measured by the trace, a fitted matrix may be.
constexpr double kFitCap = 4;

/// M_T for meshes that are no lattice. Through a triangle's six points goes one quadratic surface, whose angles are
/// θ = t κ with t from the points alone; so κ = t⁻¹ θ, and M_T = A_T t⁻ᵀ B t⁻¹ is the plate's energy of any quadratic
/// surface on any mesh. Written M_T = A_T (t B⁻¹ tᵀ)⁻¹ over the edges that have an angle, it is least over what these
/// leave open, as at free edges. On a lattice it equals MakeBendingMatrix. (The fit is that of Grinspun et al. 2006,
/// "Computing discrete shape operators on general meshes".) Six points on a conic, or nearly, determine no surface:
/// there the eigenvalues are capped, and those triangles are softer than exact.
/// Measured, plate of 40 x 40 squares jittered by 0.1, 0.2, 0.3 of their side, clamped, deflection under even load over
/// that on the lattice: 1.000, 1.002, 1.009; by areas 0.982, 0.926, 0.829.
/// `across[k]` is the point across edge k in the coordinates of `p` (UnfoldedApex), `present[k]` whether there is one.
template <class T = double>
BendingMatrix<T> MakeFittedBendingMatrix(const BendingStiffness& b, const MaterialPoint (&p)[3],
                                         const MaterialPoint (&across)[3], const bool (&present)[3]) {
  const auto twiceArea = [](const MaterialPoint& x, const MaterialPoint& y, const MaterialPoint& z) {
    return std::fabs((y.u - x.u) * (z.v - x.v) - (z.u - x.u) * (y.v - x.v));
  };
  const double area = 0.5 * twiceArea(p[0], p[1], p[2]), det = b.b11 * b.b22 - b.b12 * b.b12;
  const auto square = [](const MaterialPoint& x, const MaterialPoint& y) {
    return (y.u - x.u) * (y.u - x.u) + (y.v - x.v) * (y.v - x.v);
  };
  if (!(area > 1e-9 * (square(p[0], p[1]) + square(p[1], p[2]) + square(p[2], p[0])))) return {};  // a line
  double t[3][3] = {}, areas[3];
  for (int k = 0; k < 3; ++k) {
    const MaterialPoint corners[4] = {p[(k + 1) % 3], p[(k + 2) % 3], p[k], present[k] ? across[k] : p[k]};
    areas[k] = 0.5 * twiceArea(corners[0], corners[1], corners[3]);
    Vector3<double> x[4];
    for (int i = 0; i < 4; ++i) x[i] = {corners[i].u - p[k].u, corners[i].v - p[k].v, 0};
    const HingeWeights<double> c = MakeHingeWeights(x[0], x[1], x[2], x[3]);
    for (int i = 0; i < 4; ++i) {
      const double half = 0.5 * c.vertex[i];
      t[k][0] += half * x[i].x * x[i].x, t[k][1] += half * x[i].y * x[i].y, t[k][2] += half * x[i].x * x[i].y;
    }
  }
  double m[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double inner =
          b.b22 * t[i][0] * t[j][0] + b.b11 * t[i][1] * t[j][1] - b.b12 * (t[i][0] * t[j][1] + t[i][1] * t[j][0]);
      m[i][j] = !present[i] || !present[j] ? 0 : (inner / det + t[i][2] * t[j][2] / b.b33) / area;
    }
  }
  const BendingMatrix<double> lattice = MakeBendingMatrix(b, p, areas);
  detail::CappedInverse(m, kFitCap * (lattice.diagonal[0] + lattice.diagonal[1] + lattice.diagonal[2]) + 1e-300);
  BendingMatrix<T> result;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    if (present[k]) result.diagonal[k] = T(m[k][k]);
    if (present[k] && present[l]) result.next[k] = T(m[k][l]);
  }
  return result;
}

// --- The energy of the quadratic jumps ---

/// The constant matrix of ½ Σ M_ab ϑ_a·ϑ_b [N/m] over the six vertices, entry (i, j), i <= j, at Upper6(i, j).
template <class T>
struct QuadraticBending {
  T entry[21]{};
};

/// `weights[k]`: of edge k, in the order (corner k + 1, corner k + 2, corner k, vertex 3 + k); anything where there is
/// none.
template <class T = double>
QuadraticBending<T> MakeQuadraticBending(const BendingMatrix<double>& m, const HingeWeights<double> (&weights)[3]) {
  double c[3][6] = {};
  for (int a = 0; a < 3; ++a) {
    const double* w = weights[a].vertex;
    c[a][(a + 1) % 3] = w[0], c[a][(a + 2) % 3] = w[1], c[a][a] = w[2], c[a][3 + a] = w[3];
  }
  QuadraticBending<T> q;
  for (int j = 0; j < 6; ++j) {
    const EdgeAngles<double> mc = m * EdgeAngles<double>{{c[0][j], c[1][j], c[2][j]}};
    for (int i = 0; i <= j; ++i) {
      q.entry[Upper6(i, j)] = T(c[0][i] * mc.edge[0] + c[1][i] * mc.edge[1] + c[2][i] * mc.edge[2]);
    }
  }
  return q;
}

/// Energy [J] and its derivative by the six vertices [N].
template <class T>
struct BendingGradient {
  T energy{};
  Vector3<T> vertex[6];
};

/// Where a vertex across is missing, any finite point. Positions count from corner 0, so that float keeps the small
/// differences between large coordinates.
template <class T>
BendingGradient<T> QuadraticGradient(const QuadraticBending<T>& q, const Vector3<T> (&x)[6]) {
  BendingGradient<T> result;
  Vector3<T> y[6];
  for (int i = 1; i < 6; ++i) y[i] = x[i] - x[0];
  for (int i = 1; i < 6; ++i) {
    Vector3<T>& g = result.vertex[i];
    for (int j = 1; j < 6; ++j) g += y[j] * q.entry[i <= j ? Upper6(i, j) : Upper6(j, i)];
    result.energy += T(0.5) * Dot(g, y[i]);
    result.vertex[0] -= g;
  }
  return result;
}

// --- Plasticity ---

/// When a fold sets. A fold of curvature κ has angle κ (A1 + A2)/|e|: scale a yield curvature so for each hinge.
template <class T>
struct FoldYield {
  T angle{};       ///< Elastic part [rad] beyond which the rest angle follows; >= 0.
  T hardening{};   ///< Growth of `angle` per angle already set, >= 0. 0: perfectly plastic.
  T share = T(1);  ///< Of what is beyond, how much sets in this step, 0 .. 1; CreepShare for a rate.
};

/// Share that sets in a step of `h` [s] at a creep of `rate` [1/s], so that it does not depend on the step.
inline double CreepShare(double rate, double h) {
  return -std::expm1(-rate * h);
}

/// A rest angle, and the sum of all it has moved, which hardening needs [rad].
template <class T>
struct SetFold {
  T rest{}, moved{};
};

/// Rest angle after a step that ended at `angle`: it follows until the elastic part is at the yield, which has grown
/// meanwhile. The return mapping of Simo and Hughes 1998, "Computational inelasticity", chapter 1.
template <class T>
SetFold<T> YieldedRestAngle(T angle, const SetFold<T>& fold, const FoldYield<T>& yield) {
  const T elastic = angle - fold.rest;
  const T size = Greater(elastic, -elastic);
  const T beyond = PositivePart(size - (yield.angle + yield.hardening * fold.moved));
  const T moved = yield.share * beyond / (T(1) + yield.hardening);
  return {fold.rest + Select(elastic > T{}, moved, -moved), fold.moved + moved};
}

}  // namespace percale::fabric
