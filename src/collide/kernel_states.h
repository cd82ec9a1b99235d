// How pairs of things are, kStateLanes at a time. Included by kernels_impl.h inside the namespace of an instruction
// set, like everything there; never elsewhere.

constexpr int kStateLanes = kDoubleLanes;
using StateDoubles = Pack<double, kStateLanes, Level>;

/// Of the pairs from `first` on; where there are fewer the last stands in for what is missing.
template <PairKind kind>
inline void PairStatesFrom(const PairStateArgs& a, int first) {
  const int count = a.count - first < kStateLanes ? a.count - first : kStateLanes;
  alignas(64) double corner[4][3][kStateLanes];
  for (int i = 0; i < kStateLanes; ++i) {
    const std::int32_t* quad = a.quads + 4 * (first + (i < count ? i : count - 1));
    for (int k = 0; k < 4; ++k) {
      const Vec3& x = a.x[quad[k]];
      corner[k][0][i] = x.x, corner[k][1][i] = x.y, corner[k][2][i] = x.z;
    }
  }
  Corners<StateDoubles> x;
  for (unsigned k = 0; k < 4; ++k) {
    x[k] = {StateDoubles::Load(corner[k][0]), StateDoubles::Load(corner[k][1]), StateDoubles::Load(corner[k][2])};
  }
  const Closest<StateDoubles> closest =
      kind == PairKind::VertexTriangle ? ClosestVertexTriangle(x) : ClosestEdgeEdge(x);
  const StateDoubles zero(0.0), one(1.0), length = Sqrt(closest.squared);
  const auto apart = length > zero;
  const StateDoubles over = one / Select(apart, length, one);
  const Vector3<StateDoubles> normal{Select(apart, closest.way.x * over, zero),
                                     Select(apart, closest.way.y * over, one),
                                     Select(apart, closest.way.z * over, zero)};
  const StateDoubles gap = Select(apart, Greater(GapAlong(kind, x, normal), zero), zero);
  alignas(64) double state[PairStateArgs::kNumbers][kStateLanes];
  for (unsigned k = 0; k < 4; ++k) closest.weight[k].Store(state[k]);
  normal.x.Store(state[4]), normal.y.Store(state[5]), normal.z.Store(state[6]);
  gap.Store(state[7]);
  for (int i = 0; i < count; ++i) {
    double* to = a.states + PairStateArgs::kNumbers * (first + i);
    for (int n = 0; n < PairStateArgs::kNumbers; ++n) to[n] = state[n][i];
  }
}

[[gnu::flatten]] void PairStates(const PairStateArgs& a) {
  for (int first = 0; first < a.count; first += kStateLanes) {
    if (a.edges)
      PairStatesFrom<PairKind::EdgeEdge>(a, first);
    else
      PairStatesFrom<PairKind::VertexTriangle>(a, first);
  }
}
