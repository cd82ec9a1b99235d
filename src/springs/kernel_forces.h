// Forces and integration. Included by kernels_impl.h inside the namespace of an instruction set,
// like everything there; never elsewhere.

constexpr int kRun = 64;  // points that go through one stage before the next; tuned on pinned2

/// What the springs that the points of a run create pull their other ends by; their creators they pull as much
/// the other way. Ahead of the run stands the last block of the one before.
struct alignas(64) Pulls {
  static constexpr int kStride = kLanes + kRun;
  double axes[kKinds][3 * kStride] = {};

  /// By the springs of a kind that the points from `at` on create, counted from the start of the run.
  Pack3 Get(int kind, int at) const { return LoadStrided3(axes[kind] + kLanes + at, kStride); }
  void Put(int kind, int at, const Pack3& pull) { StoreStrided3(axes[kind] + kLanes + at, kStride, pull); }
  void NextRun() {
    for (int kind = 0; kind < kKinds; ++kind) Put(kind, -kLanes, Get(kind, kRun - kLanes));
  }
};

/// What the springs pull by that a block of points from p on creates, which is the one at `at` in its run.
inline void PutPulls(const IntegrateArgs& a, std::int64_t p, const Steps& step, const Pack stiffness[kKinds],
                     Pulls& pulls, int at) {
  const Pack3 x = Load3(a.x, p);
  Pack roots[kKinds];
  if constexpr (kQuickRoots) {  // all kinds side by side, which takes many registers
    Pack squared[kKinds];
    for (int k = 0; k < kKinds; ++k) squared[k] = SquaredLength(x - Load3(a.x, p + step[k]));
    if (!QuickSqrt(squared, roots)) {
      for (int k = 0; k < kKinds; ++k) roots[k] = Sqrt(squared[k]);
    }
  }
  for (int k = 0; k < kKinds; ++k) {
    const Pack3 d = x - Load3(a.x, p + step[k]);
    const Pack length = kQuickRoots ? roots[k] : Sqrt(SquaredLength(d)), rest = Load(a.rest[k] + p);
    // A spring that does not exist pulls nothing, and neither does one whose ends coincide: it has no direction.
    // Other lengths are roots of numbers above 4e-324, and so above 1e-180 of any rest length.
    const Mask pulling = length * All(1e180) > rest;
    pulls.Put(k, at, d * Where(pulling, stiffness[k] * (length - rest) / length));
  }
}

/// The last sums of forces, one per point, in a ring. The block at the ring's start stands at its end too, so
/// that any kLanes neighbours can be read at once.
struct ForceRing {
  double* start;
  int size;

  Pack3 Get(int slot) const { return LoadStrided3(start + slot, size + kGridPad); }
  void Put(int slot, const Pack3& sum) const {
    StoreStrided3(start + slot, size + kGridPad, sum);
    if (slot == 0) StoreStrided3(start + size, size + kGridPad, sum);
  }
};

/// Where Verlet's rule takes points.
inline Pack3 Verlet(const IntegrateArgs& a, const Pack3& x, const Pack3& previous, const Pack3& force) {
  return x + (x - previous) * All(a.keep) + force * All(a.forceToWay);
}
inline Mask IsOutside(const Pack3& x, double bound) {
  return Outside(x.x, bound) | Outside(x.y, bound) | Outside(x.z, bound);
}

/// The sheet is walked as one line of points, a run after the other; springs that would reach from the
/// end of a row to the start of another do not exist. A point feels the springs that it creates, and
/// then those that the points 1, 2, n - 1, n, n + 1 and 2 n farther on create: in this order, which
/// is that of creation, they are summed. So once the springs of points p are known, the sums of points p - 2 end with
/// the last ones of their own row, those of points p - n - 1 with the last ones of the next row, and those of points
/// p - 2 n are complete, and these move. Forces read positions only, and the new ones go where the previous ones
/// were.
///
/// Of a run, first all pulls are put and then all sums are made: apart, both need few registers, and pulls are read a
/// point or two beside where they were written, which takes long until they have reached the cache.
std::int64_t Integrate(const IntegrateArgs& a) {
  const int n = a.numWidth;
  const std::int64_t begin = std::int64_t{a.rowBegin} * n, end = std::int64_t{a.rowEnd} * n;
  const std::int64_t endOfCreators = std::int64_t{a.rowEnd + 2 < a.numHeight ? a.rowEnd + 2 : a.numHeight} * n;
  const Steps step(n);
  const int size = ForceRingSize(n);
  const ForceRing ofOwnRow{a.scratch, size}, ofNextRow{a.scratch + 3 * (size + kGridPad), size};

  // Never a negative zero: adding the zero of a spring that does not exist must not change a sum.
  const Pack3 weight = {All(0 + a.weight[0]), All(0 + a.weight[1]), All(0 + a.weight[2])};
  Pack stiffness[kKinds];
  for (int k = 0; k < kKinds; ++k) stiffness[k] = All(a.stiffness[k]);
  Pulls pulls;
  Mask outOfBounds = FirstLanes(0);
  const std::int64_t lastWhole = end - kLanes;  // block that moves
  Pack3 last = Zero3();                         // forces on the points after it
  int slot = 0;
  // Some points too early, so that those that move are whole blocks; nobody feels the springs of these.
  const std::int64_t first = begin + 2 * n - (2 * n + kLanes - 1) / kLanes * kLanes;
  for (std::int64_t start = first; start - 2 * n < end; start += kRun) {
    const std::int64_t left = end + 2 * n - start, creators = endOfCreators - start;
    const int count = static_cast<int>(left < kRun ? left : kRun);
    for (int at = 0; at < count; at += kLanes) {
      if (at < creators) {
        PutPulls(a, start + at, step, stiffness, pulls, at);
      } else {
        for (int k = 0; k < kKinds; ++k) pulls.Put(k, at, Zero3());
      }
    }

    for (int at = 0; at < count; at += kLanes, slot = slot + kLanes < size ? slot + kLanes : 0) {
      const int rowBefore = slot >= n - 1 ? slot - (n - 1) : slot - (n - 1) + size;
      Pack3 sum = weight;
      if (a.extraForce[0] && at - 2 < creators) sum = sum + Load3(a.extraForce, start + at - 2);
      for (int k = 0; k < kKinds; ++k) sum = sum - pulls.Get(k, at - 2);
      ofOwnRow.Put(slot, sum + pulls.Get(kLeft, at - 1) + pulls.Get(kTwoLeft, at));
      ofNextRow.Put(slot, ofOwnRow.Get(rowBefore) + pulls.Get(kUpperRight, at - 2) + pulls.Get(kUp, at - 1) +
                              pulls.Get(kUpperLeft, at));
      const Pack3 complete = ofNextRow.Get(rowBefore) + pulls.Get(kTwoUp, at);

      const std::int64_t moved = start + at - 2 * n;
      if (moved < begin) continue;
      if (moved > lastWhole) {
        last = complete;
        break;
      }
      const Pack3 next = Verlet(a, Load3(a.x, moved), Load3(a.previous, moved), complete);
      Store3(a.previous, moved, next);
      outOfBounds = outOfBounds | IsOutside(next, a.bound);
    }
    pulls.NextRun();
  }
  // What is beyond the last row belongs to others.
  const int count = static_cast<int>((end - begin) % kLanes);
  const Pack3 next = Verlet(a, LoadFirst3(a.x, end - count, count), LoadFirst3(a.previous, end - count, count), last);
  StoreFirst3(a.previous, end - count, next, count);
  return Bits(outOfBounds | (FirstLanes(count) & IsOutside(next, a.bound)));
}
