// The boxes of vertices, items, leaves and nodes. Included by kernels_impl.h inside the namespace of an instruction
// set, like everything there; never elsewhere.

constexpr float kInfinity = INFINITY;

inline Floats Max(Floats a, Floats b) {
  return Select(a > b, a, b);
}
inline Floats Abs(Floats a) {
  return Max(a, -a);
}

/// A box that grows.
struct Row {
  Floats extent[3];  // four numbers each, as BoxRow has them

  static Row Load(const BoxRow& from) {
    Row row;
    for (int i = 0; i < 3; ++i) row.extent[i] = Floats::Load(from.extent + 4 * i);
    return row;
  }
  static Row Empty() {
    Row row;
    for (int i = 0; i < 3; ++i) row.extent[i] = Floats(-kInfinity);
    return row;
  }
  void Add(const Row& o) {
    for (int i = 0; i < 3; ++i) extent[i] = Max(extent[i], o.extent[i]);
  }
  /// Into one lane.
  void Store(BoxBlock& to, int lane) const {
    for (int i = 0; i < 12; ++i) to.extent[i][lane] = extent[i / 4][i % 4];
  }
};

/// The numbers of a vertex's row. Some more can be read behind them.
inline const float* RowAt(const BoxRow* rows, int vertex) {
  return reinterpret_cast<const float*>(rows + vertex);
}

// What is within the reach r of x, in floats: of size |x| and r are the conversions' errors, at most 2^-24 of it, and
// those of the two operations that follow; 2^-22 are more than all. The last term is for what underflows.
constexpr double kMore = 0x1p-22, kLeast = 1e-37;

void VertexRows(const RowArgs& a) {
  const double origin[4] = {a.origin[0], a.origin[1], a.origin[2], 0};
  const double originWay[4] = {a.originWay[0], a.originWay[1], a.originWay[2], 0};
  const Doubles o = Doubles::Load(origin), oWay = Doubles::Load(originWay);
  const Floats more(kMore);
  const auto put = [&](int v, const double* start, const double* way) {
    const Doubles from = Doubles::Load(start) - o;
    const Floats s(from), e(from + (Doubles::Load(way) - oWay));
    const Floats size = Abs(s) + Abs(e), reach(a.reach[a.body[v]] * (1 + kMore) + kLeast);
    Floats below[2] = {Floats(-kInfinity), Floats(-kInfinity)}, above[2] = {below[0], below[1]};
    if (size[0] + size[1] + size[2] < kFarthest) {
      const Floats atStart = Abs(s) * more + reach, atEnd = Abs(e) * more + reach;
      below[0] = -(s - atStart);
      above[0] = s + atStart;
      below[1] = -(e - atEnd);
      above[1] = e + atEnd;
      if (a.cut && a.cut[v] != 0) {  // it may also end where it starts
        const Floats r(from - oWay), atRest = Abs(r) * more + reach;
        below[1] = Max(-(r - atRest), below[1]);
        above[1] = Max(r + atRest, above[1]);
      }
    }
    // Three of four numbers count: the next ones overwrite the fourth.
    float last[4], *to = a.rows[v].extent;
    below[0].Store(to);
    below[1].Store(to + 3);
    above[0].Store(to + 6);
    above[1].Store(last);
    memcpy(to + 9, last, 3 * sizeof last[0]);
  };
  const int whole = a.end < a.vertices ? a.end : a.vertices - 1;  // four numbers can be read
  for (int v = a.begin; v < whole; ++v) put(v, &a.start[v].x, &a.way[v].x);
  for (int v = whole; v < a.end; ++v) {
    const double start[4] = {a.start[v].x, a.start[v].y, a.start[v].z, 0};
    const double way[4] = {a.way[v].x, a.way[v].y, a.way[v].z, 0};
    put(v, start, way);
  }
}

void LeafBoxes(const LeafBoxArgs& a) {
  for (int leaf = a.begin * kLanes; leaf < a.end * kLanes; ++leaf) {
    Row sum = Row::Empty();
    if (leaf < a.leaves) {
      for (int i = a.vertexFirst[leaf]; i < a.vertexFirst[leaf + 1]; ++i) sum.Add(Row::Load(a.rows[a.vertices[i]]));
    }
    sum.Store(a.boxes[leaf / kLanes], leaf % kLanes);
  }
}

void ParentBoxes(const BoxBlock* boxes, int blocks, BoxBlock* parents) {
  for (int block = 0; block < blocks; ++block) {
    BoxBlock& parent = parents[block / kLanes];
    for (int i = 0; i < 12; ++i) {
      float most = -kInfinity;
      for (const float x : boxes[block].extent[i]) most = x > most ? x : most;
      parent.extent[i][block % kLanes] = most;
    }
  }
}

/// Four rows of x, y, z become four x, four y, four z; or so of four numbers each.
template <int numbers>
inline void StoreTransposed(const Floats rows[4], float (*to)[kLanes], int lane) {
#if defined(__GNUC__)
  const auto xy0 = __builtin_shufflevector(rows[0].v, rows[1].v, 0, 4, 1, 5);
  const auto xy2 = __builtin_shufflevector(rows[2].v, rows[3].v, 0, 4, 1, 5);
  const auto zw0 = __builtin_shufflevector(rows[0].v, rows[1].v, 2, 6, 3, 7);
  const auto zw2 = __builtin_shufflevector(rows[2].v, rows[3].v, 2, 6, 3, 7);
  Floats(__builtin_shufflevector(xy0, xy2, 0, 1, 4, 5)).Store(to[0] + lane);
  Floats(__builtin_shufflevector(xy0, xy2, 2, 3, 6, 7)).Store(to[1] + lane);
  Floats(__builtin_shufflevector(zw0, zw2, 0, 1, 4, 5)).Store(to[2] + lane);
  if (numbers > 3) Floats(__builtin_shufflevector(zw0, zw2, 2, 3, 6, 7)).Store(to[3] + lane);
#else
  for (int i = 0; i < numbers; ++i) {
    for (int k = 0; k < 4; ++k) to[i][lane + k] = rows[k][i];
  }
#endif
}

template <int corners>
void ItemBoxes(const ItemBoxArgs& a) {
  for (int first = 0; first < a.items; first += 4) {
    Floats extent[3][4];
    for (int k = 0; k < 4; ++k) {
      Row row = Row::Empty();
      if (first + k < a.items) {
        const std::int32_t* at = a.corners + corners * (first + k);
        row = Row::Load(a.rows[at[0]]);
        if (corners > 1) row.Add(Row::Load(a.rows[at[1]]));
        if (corners > 2) row.Add(Row::Load(a.rows[at[2]]));
      }
      for (int i = 0; i < 3; ++i) extent[i][k] = row.extent[i];
    }
    BoxBlock& block = a.boxes[first / kLanes];
    for (int i = 0; i < 3; ++i) StoreTransposed<4>(extent[i], block.extent + 4 * i, first % kLanes);
  }
}

void ItemBoxes(const ItemBoxArgs& a) {
  if (a.cornersPerItem == 1) ItemBoxes<1>(a);
  if (a.cornersPerItem == 2) ItemBoxes<2>(a);
  if (a.cornersPerItem == 3) ItemBoxes<3>(a);
}
