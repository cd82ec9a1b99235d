// How leaves lie in space. Included by kernels_impl.h inside the namespace of an instruction set, like everything
// there; never elsewhere.

using Floats8 = Pack<float, 8, Level>;  // x, y, z of the start, of the end, and two numbers that say nothing

constexpr int kMostTriangles = 16;
constexpr float kRowError = 0x1p-20f;    // of a coordinate's size: rows are rounded, and so is what follows from them
constexpr float kShapeError = 0x1p-16f;  // of a shape's size, likewise

/// The most that a vertex of the leaf may be from the middles of its boxes.
inline float GreatestError(const LeafShapeArgs& a, int leaf) {
  float size = 0, sum = 0;
  const float* box = BoxAt(a.boxes, leaf);
  for (int i = 0; i < 12; ++i) {
    const float extent = box[i * kLanes] < 0 ? -box[i * kLanes] : box[i * kLanes];
    size = extent > size ? extent : size;
  }
  if (a.haveCuts) {
    Floats more(0);
    for (int i = a.vertexFirst[leaf]; i < a.vertexFirst[leaf + 1]; ++i) {
      const float* extent = RowAt(a.rows, a.vertices[i]);
      const Floats atStart = Floats::Load(extent + 6) + Floats::Load(extent);
      const Floats atEnd = Floats::Load(extent + 9) + Floats::Load(extent + 3);
      more = Max(more, atEnd - atStart);
    }
    sum = more[0] + more[1] + more[2];
  }
  return size * kRowError + sum;
}

/// x, y, z of the start, and of the end, and a number that says nothing.
struct Halves {
  Floats start, end;

  explicit Halves(Floats8 a) {
#if defined(__GNUC__)
    start = Floats(__builtin_shufflevector(a.v, a.v, 0, 1, 2, 3));
    end = Floats(__builtin_shufflevector(a.v, a.v, 3, 4, 5, 6));
#else
    float both[8];
    a.Store(both);
    start = Floats::Load(both);
    end = Floats::Load(both + 3);
#endif
  }
};

/// x + y + z of the start in the first lane, and of the end in the last.
inline Floats Sums(Floats8 a) {
#if defined(__GNUC__)
  const Floats x(__builtin_shufflevector(a.v, a.v, 0, 1, 2, 3)), rest(__builtin_shufflevector(a.v, a.v, 4, 5, 6, 7));
  const Floats y(__builtin_shufflevector(x.v, rest.v, 1, 1, 4, 4)), z(__builtin_shufflevector(x.v, rest.v, 2, 2, 5, 5));
  return x + y + z;
#else
  Floats sums;
  sums.v[0] = a[0] + a[1] + a[2];
  sums.v[3] = a[3] + a[4] + a[5];
  return sums;
#endif
}

/// From twice as large ones.
inline void StoreShapes(const Floats8* shapes, int blocks, float (*to)[3][kLanes]) {
  const Floats half(0.5);
  for (int first = 0; first < blocks * kLanes; first += 4) {
    Floats start[4], end[4];
    for (int k = 0; k < 4; ++k) {
      const Halves halves(shapes[first + k]);
      start[k] = halves.start * half;
      end[k] = halves.end * half;
    }
    StoreTransposed<3>(start, to[first / kLanes], first % kLanes);
    StoreTransposed<3>(end, to[blocks + first / kLanes], first % kLanes);
  }
}

/// Twice the shapes of a leaf's triangles. Returns how many.
inline int DoubleShapes(const LeafShapeArgs& a, int leaf, Floats8* x, Floats8* y) {
  const int begin = a.triangleFirst[leaf], count = a.triangleFirst[leaf + 1] - begin;
  const auto twiceMiddle = [&](int v) {
    const float* extent = RowAt(a.rows, v);
    return Floats8::Load(extent + 6) - Floats8::Load(extent);
  };
  for (int t = 0; t < count; ++t) {
    const std::int32_t* corners = a.corners + 3 * (begin + t);
    const float* inverse = a.inverse + 4 * (a.inverseFirst[leaf] + t);
    const Floats8 p = twiceMiddle(corners[0]), ab = twiceMiddle(corners[1]) - p, ac = twiceMiddle(corners[2]) - p;
    x[t] = ab * Floats8(inverse[0]) + ac * Floats8(inverse[2]);
    y[t] = ab * Floats8(inverse[1]) + ac * Floats8(inverse[3]);
  }
  return count;
}

void ShapeTriangles(const LeafShapeArgs& a, int leaf, TriangleShapes& to) {
  Floats8 x[kMostTriangles], y[kMostTriangles];
  const int count = DoubleShapes(a, leaf, x, y), blocks = (count + kLanes - 1) / kLanes;
  for (int t = count; t < blocks * kLanes; ++t) {
    x[t] = x[0];
    y[t] = y[0];
  }
  StoreShapes(x, blocks, to.x);
  StoreShapes(y, blocks, to.y);
  to.blocks = 2 * blocks;
}

void LeafShapes(const LeafShapeArgs& a) {
  for (int leaf = a.begin; leaf < a.end; ++leaf) {
    if (a.greatestSlope[leaf] < 0) continue;
    Floats8 x[kMostTriangles], y[kMostTriangles], sumX, sumY;
    const int count = DoubleShapes(a, leaf, x, y);
    for (int t = 0; t < count; ++t) {
      sumX += x[t];
      sumY += y[t];
    }
    LeafShape& shape = a.shapes[leaf];
    float meanX[8] = {}, meanY[8] = {}, size = 0;
    const float share = 0.25f / static_cast<float>(count);
    for (int i = 0; i < 3; ++i) {
      meanX[i] = meanX[i + 3] = (sumX[i] + sumX[i + 3]) * share * 2;
      meanY[i] = meanY[i + 3] = (sumY[i] + sumY[i + 3]) * share * 2;
    }
    for (int i = 0; i < 3; ++i) {
      shape.x[i] = meanX[i] / 2;
      shape.y[i] = meanY[i] / 2;
      size += (meanX[i] < 0 ? -meanX[i] : meanX[i]) + (meanY[i] < 0 ? -meanY[i] : meanY[i]);
    }
    const Floats8 middleX = Floats8::Load(meanX), middleY = Floats8::Load(meanY);
    Floats greatest;
    for (int t = 0; t < count; ++t) {
      const Floats8 dx = x[t] - middleX, dy = y[t] - middleY;
      greatest = Max(Sums(dx * dx + dy * dy), greatest);
    }
    const float square = greatest[0] > greatest[3] ? greatest[0] : greatest[3];
    shape.error = a.greatestSlope[leaf] * GreatestError(a, leaf) + size * kShapeError;
    shape.deviation = Sqrt(Floats(square))[0] / 2 + shape.error;
  }
}

bool AreMonotone(const TriangleShapes& triangles, const float x[3], const float y[3], float least) {
  const auto dot = [](const Floats8 g[3], const float f[3][kLanes]) {
    return g[0] * Floats8::Load(f[0]) + g[1] * Floats8::Load(f[1]) + g[2] * Floats8::Load(f[2]);
  };
  const Floats8 gx[3] = {Floats8(x[0]), Floats8(x[1]), Floats8(x[2])};
  const Floats8 gy[3] = {Floats8(y[0]), Floats8(y[1]), Floats8(y[2])};
  const Floats8 half(0.5), bound(least), none(0), no(-1);
  Floats8 worst(1);
  for (int block = 0; block < triangles.blocks; ++block) {
    const auto *fx = triangles.x[block], *fy = triangles.y[block];
    // The lesser eigenvalue is (xx + yy) / 2 - root(((xx - yy) / 2)^2 + xy^2).
    const Floats8 xx = dot(gx, fx), yy = dot(gy, fy), xy = (dot(gx, fy) + dot(gy, fx)) * half;
    const Floats8 root = (xx + yy) * half - bound, difference = (xx - yy) * half;
    const Floats8 more = Select(root > none, root * root - (difference * difference + xy * xy), no);
    worst = Select(more > none, worst, no);
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    if (worst[lane] < 0) return false;
  }
  return true;
}
