// The membrane, kLanes triangles at a time. Included by kernels_impl.h inside the namespace of an instruction set;
// never elsewhere. Positions, strains, energies and the gradient are in double, the second derivative in float.

static_assert(kLanes <= kTrianglePad && kTrianglePad % kLanes == 0);

/// kLanes triangles from `first` on. Where there are fewer the last stands in for what is missing.
struct Triangles {
  RestTriangle<Doubles> rest;  ///< Strength counts as so much more area.
  Doubles flat, strength;      ///< The area alone, and the strength.
  DeformationGradient<Doubles> f;
};

/// What lead from their first corners to the others.
struct Edges {
  Vector3<Doubles> first, second;
};
inline Edges LoadEdges(const Triangle* triangles, const Vec3* x, int first, int count) {
  alignas(64) double edge[6][kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const Triangle& t = triangles[first + (i < count ? i : count - 1)];
    const Vec3 &x0 = x[t.a], &x1 = x[t.b], &x2 = x[t.c];
    edge[0][i] = x1.x - x0.x, edge[1][i] = x1.y - x0.y, edge[2][i] = x1.z - x0.z;
    edge[3][i] = x2.x - x0.x, edge[4][i] = x2.y - x0.y, edge[5][i] = x2.z - x0.z;
  }
  return {{Doubles::Load(edge[0]), Doubles::Load(edge[1]), Doubles::Load(edge[2])},
          {Doubles::Load(edge[3]), Doubles::Load(edge[4]), Doubles::Load(edge[5])}};
}

/// A number per triangle, or one where there are none.
inline Doubles LoadFactors(const double* factors, int first, int count) {
  if (!factors) return Doubles(1);
  alignas(64) double factor[kLanes];
  for (int i = 0; i < kLanes; ++i) factor[i] = factors[first + (i < count ? i : count - 1)];
  return Doubles::Load(factor);
}

/// MakeRestTriangle, to the bit.
inline RestTriangle<Doubles> LoadRest(const MembraneArgs& a, int first, int count) {
  alignas(64) double edge[4][kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const int at = first + (i < count ? i : count - 1);
    const Triangle& t = a.chartTriangles[at];
    const Vec2 &p0 = a.chart[t.a], &p1 = a.chart[t.b], &p2 = a.chart[t.c];
    edge[0][i] = p1.x - p0.x, edge[1][i] = p1.y - p0.y;
    edge[2][i] = p2.x - p0.x, edge[3][i] = p2.y - p0.y;
  }
  const Doubles u1 = Doubles::Load(edge[0]), v1 = Doubles::Load(edge[1]);
  const Doubles u2 = Doubles::Load(edge[2]), v2 = Doubles::Load(edge[3]);
  const Doubles det = u1 * v2 - u2 * v1, none(0), size = Select(det > none, det, -det);
  const Doubles over = Doubles(1) / det, positive = Select(det > none, over, -over);
  constexpr double kBelowNormal = 0x1.ffffffffffffep-1023;
  const auto isNormal = Select(size > positive, positive, size) > Doubles(kBelowNormal);
  return {Select(isNormal, Doubles(0.5) * size, none),
          {Select(isNormal, v2 * over, none), Select(isNormal, -u2 * over, none), Select(isNormal, -v1 * over, none),
           Select(isNormal, u1 * over, none)}};
}

inline Triangles LoadTriangles(const MembraneArgs& a, int first, int count) {
  const Edges edges = LoadEdges(a.triangles, a.x, first, count);
  Triangles triangles;
  triangles.rest = LoadRest(a, first, count);
  triangles.flat = triangles.rest.area;
  triangles.strength = LoadFactors(a.strength, first, count);
  triangles.rest.area = triangles.flat * triangles.strength;
  triangles.f = Deformation(triangles.rest, Vector3<Doubles>{}, edges.first, edges.second);
  return triangles;
}

template <class T>
StVenantKirchhoff<T> InLanes(const StVenantKirchhoff<double>& law) {
  return {T(law.c11),
          T(law.c12),
          T(law.c22),
          T(law.c33),
          T(law.limitU),
          T(law.limitV),
          T(law.limitStiffnessU),
          T(law.limitStiffnessV)};
}
template <class T>
StableNeoHookean<T> InLanes(const StableNeoHookean<double>& law) {
  return {T(law.mu), T(law.lambdaPrime)};
}

inline MembraneDamping<Doubles> LoadDamping(const MembraneArgs& a, int first) {
  if (a.damping == 0) return {};
  return {Doubles(a.damping),
          {Doubles::Load(a.startStrain[0] + first), Doubles::Load(a.startStrain[1] + first),
           Doubles::Load(a.startStrain[2] + first)}};
}

/// How much compression a second derivative may keep [N/m].
inline Doubles LoadFloor(const MembraneArgs& a, const Triangles& triangles, int first, int count) {
  alignas(64) double mass[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const Triangle& t = a.triangles[first + (i < count ? i : count - 1)];
    mass[i] = a.mass[t.a] + a.mass[t.b] + a.mass[t.c];
  }
  const Doubles stiffness = Doubles(a.bendStiffness) * LoadFactors(a.stiffening, first, count);
  const Doubles stress = BucklingStress(stiffness, Doubles::Load(mass), triangles.flat);
  return (a.strength ? stress / triangles.strength : stress) * Doubles(a.compression);
}

inline Vector3<Floats> ToFloats(const Vector3<Doubles>& v) {
  return {Floats(v.x), Floats(v.y), Floats(v.z)};
}

/// Calls body(first, count) for kLanes triangles at a time.
template <class Body>
inline void ForTriangles(int begin, int end, Body&& body) {
  for (int first = begin; first < end; first += kLanes) body(first, end - first < kLanes ? end - first : kLanes);
}

[[gnu::flatten]] void MembraneStrains(const MembraneArgs& a) {
  ForTriangles(a.begin, a.end, [&](int first, int count) {
    const MembraneStrain<Doubles> strain = GreenStrain(LoadTriangles(a, first, count).f);
    for (int i = 0; i < count; ++i) {
      a.startStrain[0][first + i] = strain.e11[i];
      a.startStrain[1][first + i] = strain.e22[i];
      a.startStrain[2][first + i] = strain.shear[i];
    }
  });
}

[[gnu::flatten]] MembraneStretch MembraneStretches(const MembraneArgs& a) {
  MembraneStretch greatest;
  ForTriangles(a.begin, a.end, [&](int first, int count) {
    const Doubles square = SquaredStretch(LoadTriangles(a, first, count).f);
    for (int i = 0; i < count; ++i) {
      if (square[i] > greatest.square) greatest = {square[i], first + i};
    }
  });
  return greatest;
}

// The two laws alike: only one knows of damping.
template <class T>
MembraneStress<T> StressOf(const StVenantKirchhoff<T>& law, const DeformationGradient<T>& f,
                           const MembraneDamping<T>& damping) {
  return Stress(law, f, damping);
}
template <class T>
MembraneStress<T> StressOf(const StableNeoHookean<T>& law, const DeformationGradient<T>& f, const MembraneDamping<T>&) {
  return Stress(law, f);
}
template <class T>
MembraneTangent<T> TangentOf(const StVenantKirchhoff<T>& law, const DeformationGradient<T>& f, T floor,
                             const MembraneDamping<T>& damping) {
  return Tangent(law, f, floor, damping);
}
template <class T>
MembraneTangent<T> TangentOf(const StableNeoHookean<T>& law, const DeformationGradient<T>& f, T floor,
                             const MembraneDamping<T>&) {
  return Tangent(law, f, floor);
}

[[gnu::flatten]] double EnergyBy(const MembraneArgs& a, const auto& law) {
  // Sums go by the place of a triangle modulo kTrianglePad, so that they do not depend on kLanes.
  constexpr int kSums = kTrianglePad / kLanes;
  Doubles sums[kSums];
  int next = 0;
  ForTriangles(a.begin, a.end, [&](int first, int count) {
    const Triangles t = LoadTriangles(a, first, count);
    Doubles energy = t.rest.area * StressOf(law, t.f, LoadDamping(a, first)).energy;
    for (int i = count; i < kLanes; ++i) energy.v[i] = 0;
    sums[next] += energy;
    next = (next + 1) % kSums;
  });
  double total = 0;
  for (int i = 0; i < kTrianglePad; ++i) total += sums[i / kLanes][i % kLanes];
  return total;
}

double MembraneEnergy(const MembraneArgs& a) {
  return a.law == MembraneLaw::NeoHookean ? EnergyBy(a, InLanes<Doubles>(a.neoHookean))
                                          : EnergyBy(a, InLanes<Doubles>(a.orthotropic));
}

template <bool withTangent>
[[gnu::flatten]] void DerivativesBy(const MembraneArgs& a, const auto& law, const auto& floatLaw) {
  ForTriangles(a.begin, a.end, [&](int first, int count) {
    const Triangles t = LoadTriangles(a, first, count);
    const MembraneDamping<Doubles> damping = LoadDamping(a, first);
    const TriangleGradient<Doubles> gradient = CornerGradient(t.rest, StressOf(law, t.f, damping));
    double lanes[9][kLanes];
    for (int k = 0; k < 3; ++k) {
      gradient.corner[k].x.Store(lanes[3 * k]);
      gradient.corner[k].y.Store(lanes[3 * k + 1]);
      gradient.corner[k].z.Store(lanes[3 * k + 2]);
    }
    for (int i = 0; i < count; ++i) {
      Vec3* to = a.gradient + 3 * static_cast<std::int64_t>(first + i - a.outFirst);
      for (int k = 0; k < 3; ++k) {
        to[k].x = lanes[3 * k][i], to[k].y = lanes[3 * k + 1][i], to[k].z = lanes[3 * k + 2][i];
      }
    }
    if constexpr (withTangent) {
      RestTriangle<Floats> rest;
      rest.area = Floats(t.rest.area);
      for (int k = 0; k < 4; ++k) rest.inverse[k] = Floats(t.rest.inverse[k]);
      const DeformationGradient<Floats> f{ToFloats(t.f.u), ToFloats(t.f.v)};
      const MembraneDamping<Floats> floatDamping{
          Floats(damping.rate), {Floats(damping.start.e11), Floats(damping.start.e22), Floats(damping.start.shear)}};
      const Floats floor(LoadFloor(a, t, first, count));
      const TriangleHessian<Floats> hessian = CornerHessian(rest, TangentOf(floatLaw, f, floor, floatDamping));
      Real blocks[27][kLanes];
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 9; ++c) hessian.next[k].m[c % 3 * 3 + c / 3].Store(blocks[9 * k + c]);
      }
      for (int i = 0; i < count; ++i) {
        Real* to = a.hessian + kHessianReals * static_cast<std::int64_t>(first + i - a.outFirst);
        for (int k = 0; k < 27; ++k) to[k] = blocks[k][i];
      }
    }
  });
}

template <bool withTangent>
void MembraneDerivatives(const MembraneArgs& a) {
  if (a.law == MembraneLaw::NeoHookean)
    DerivativesBy<withTangent>(a, InLanes<Doubles>(a.neoHookean), InLanes<Floats>(a.neoHookean));
  else
    DerivativesBy<withTangent>(a, InLanes<Doubles>(a.orthotropic), InLanes<Floats>(a.orthotropic));
}
