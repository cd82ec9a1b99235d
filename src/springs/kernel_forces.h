// Forces and integration. Included by kernels_impl.h inside the namespace of an instruction set,
// like everything there; never elsewhere.

/// The springs of each kind that a block of neighbouring points create.
struct BlockSprings {
  Pack3 d[kKinds];  // from the creators to the other ends
  Pack length[kKinds];
  bool coincide;  // whether some ends may
};

/// The kinds go side by side, since each is one long chain of operations.
inline void Measure(const IntegrateArgs& a, std::int64_t at, const Steps& step, BlockSprings& springs) {
  const Pack3 x = Load3(a.x, at);
  Pack squared[kKinds];
  for (int k = 0; k < kKinds; ++k) springs.d[k] = Load3(a.x, at + step[k]) - x;
  for (int k = 0; k < kKinds; ++k) squared[k] = SquaredLength(springs.d[k]);
  springs.coincide = !QuickSqrt(squared, springs.length);
  if (springs.coincide) {
    for (int k = 0; k < kKinds; ++k) springs.length[k] = Sqrt(squared[k]);
  }
}

/// Force over length of each spring; 0 where there is none, or where its ends coincide and it has no
/// direction.
inline void ForcesPerLength(const IntegrateArgs& a, std::int64_t at, const BlockSprings& springs, Pack factor[kKinds]) {
  for (int k = 0; k < kKinds; ++k) {
    const Pack rest = Load(a.rest[k] + at), length = springs.length[k];
    factor[k] = Where(All(kNoSpringRest) > rest, All(a.stiffness[k]) * (length - rest) / length);
  }
  if (springs.coincide) {
    for (int k = 0; k < kKinds; ++k) factor[k] = Where(springs.length[k] > All(0), factor[k]);
  }
}

/// Verlet for the first `count` points from `at` on, whose forces are complete; others are neither read
/// nor written. Returns which went out of bounds.
inline Mask Verlet(const IntegrateArgs& a, std::int64_t at, int count, const Pack3& force) {
  const Pack keep = All(a.keep), forceToWay = All(a.forceToWay);
  const Pack3 x = Load3(a.x, at), previous = LoadFirst3(a.previous, at, count);
  const Pack3 next = x + (x - previous) * keep + force * forceToWay;
  StoreFirst3(a.previous, at, next, count);
  return FirstLanes(count) & (Outside(next.x, a.bound) | Outside(next.y, a.bound) | Outside(next.z, a.bound));
}

/// A spring's force on its creator, added to or taken from a sum of forces.
inline void AddSpring(const IntegrateArgs& a, const Steps& step, std::int64_t creator, int kind, double sign,
                      double sum[3]) {
  if (creator >= static_cast<std::int64_t>(a.numWidth) * a.numHeight || a.rest[kind][creator] == kNoSpringRest) return;
  const std::int64_t other = creator + step[kind];
  double d[3];
  for (int axis = 0; axis < 3; ++axis) d[axis] = a.x[axis][other] - a.x[axis][creator];
  const double length = Sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  if (!(length > 0)) return;
  const double factor = a.stiffness[kind] * (length - a.rest[kind][creator]) / length;
  for (int axis = 0; axis < 3; ++axis) sum[axis] += sign * (d[axis] * factor);
}

/// For sheets that have no room for a block between a point and the one below it: point by point.
std::int64_t IntegrateNarrow(const IntegrateArgs& a) {
  const std::int64_t n = a.numWidth;
  const Steps step(n);
  std::int64_t outOfBounds = 0;
  for (std::int64_t p = a.rowBegin * n; p < a.rowEnd * n; ++p) {
    double force[3] = {0 + a.weight[0], 0 + a.weight[1], 0 + a.weight[2]};  // see Integrate
    for (int axis = 0; axis < 3 && a.extraForce[0]; ++axis) force[axis] += a.extraForce[axis][p];
    for (int kind = 0; kind < kKinds; ++kind) AddSpring(a, step, p, kind, 1, force);
    AddSpring(a, step, p + 1, kLeft, -1, force);
    AddSpring(a, step, p + 2, kTwoLeft, -1, force);
    AddSpring(a, step, p + n - 1, kUpperRight, -1, force);
    AddSpring(a, step, p + n, kUp, -1, force);
    AddSpring(a, step, p + n + 1, kUpperLeft, -1, force);
    AddSpring(a, step, p + 2 * n, kTwoUp, -1, force);
    for (int axis = 0; axis < 3; ++axis) {
      const double x = a.x[axis][p];
      const double next = x + a.keep * (x - a.previous[axis][p]) + a.forceToWay * force[axis];
      outOfBounds += next <= a.bound && next >= -a.bound ? 0 : 1;
      a.previous[axis][p] = next;
    }
  }
  return outOfBounds;
}

/// The last sums of forces, one per creator of springs, in a ring. The block at the ring's start stands
/// at its end too, so that any kLanes neighbours can be read at once.
struct ForceRing {
  double* axes[3];
  int size;

  void Put(int slot, const Pack3& sum) const {
    Store3(axes, slot, sum);
    if (slot == 0) Store3(axes, size, sum);
  }
  /// Of the creators that are `back` before the one at the slot.
  Pack3 Get(int slot, int back) const { return Load3(axes, slot >= back ? slot - back : slot - back + size); }
};

/// What a block still lacks is due to springs of the block to its right.
struct Unfinished {
  Pack3 sum;                                   // on the block's points by springs of their own row
  Pack3 sumAbove;                              // on the points above them, by all springs but those of the rows below
  Pack3 left, upperLeft, upperRight, twoLeft;  // forces of the block's springs
};

/// The sheet is walked as one line of points, a block at a time; springs that would reach from the
/// end of a row to the start of another do not exist. A point feels the springs that it creates, and
/// then those that the points 1, 2, n - 1, n, n + 1 and 2 n farther on create: in this order, which
/// is that of creation, they are summed. So the springs of points p complete the forces of points
/// p - 2 n, which then move. Forces read positions only, and the new ones go where the previous ones
/// were.
std::int64_t Integrate(const IntegrateArgs& a) {
  if (a.numWidth < kLanes) return IntegrateNarrow(a);
  const int n = a.numWidth;
  const std::int64_t begin = std::int64_t{a.rowBegin} * n, end = std::int64_t{a.rowEnd} * n;
  const std::int64_t endOfCreators = std::int64_t{a.rowEnd + 2 < a.numHeight ? a.rowEnd + 2 : a.numHeight} * n;
  const Steps step(n);

  // The sums stand where the creators are whose springs went in last: for point p those of its own
  // row, for point p - n those of the next row too, for point p - 2 n all. So every block is stored at a
  // multiple of kLanes; a store across two cache lines takes many times as long.
  const int ring = ForceRingSize(n), room = ring + kGridPad;
  const auto makeRing = [&](int i) {
    double* const start = a.scratch + 3 * i * room;
    return ForceRing{{start, start + room, start + 2 * room}, ring};
  };
  const ForceRing ofOwnRow = makeRing(0), ofNextRow = makeRing(1), complete = makeRing(2);
  // Of the points that move, after the creators: so long that what they need is no longer on its way to
  // the cache, since a load that takes parts of two such stores waits for both.
  const int delay = (2 * n + kLanes - 1) / kLanes * kLanes + kForceDelay;

  // Never a negative zero: adding the zero of a spring that does not exist must not change a sum.
  const Pack3 weight = {All(0 + a.weight[0]), All(0 + a.weight[1]), All(0 + a.weight[2])};
  Mask outOfBounds = FirstLanes(0);
  BlockSprings buffers[2];
  BlockSprings *here = &buffers[0], *ahead = &buffers[1];
  Measure(a, begin, step, *here);
  Unfinished before{};
  int slot = 0;
  for (std::int64_t p = begin; p - delay < end; p += kLanes, slot = slot + kLanes < ring ? slot + kLanes : 0) {
    Pack factor[kKinds];
    Pack3 force[kKinds];
    if (p < endOfCreators) {
      // The divider is busy with this block while the next is measured.
      ForcesPerLength(a, p, *here, factor);
      if (p + kLanes < endOfCreators) Measure(a, p + kLanes, step, *ahead);
      for (int k = 0; k < kKinds; ++k) force[k] = here->d[k] * factor[k];
      BlockSprings* const done = here;
      here = ahead;
      ahead = done;
    } else {
      for (Pack3& f : force) f = Zero3();
    }

    const int slotBefore = (slot > 0 ? slot : ring) - kLanes;
    ofOwnRow.Put(slotBefore,
                 before.sum - Shift<1>(before.left, force[kLeft]) - Shift<2>(before.twoLeft, force[kTwoLeft]));
    ofNextRow.Put(slotBefore, before.sumAbove - Shift<1>(before.upperLeft, force[kUpperLeft]));
    before.sumAbove = ofOwnRow.Get(slot, n) - Shift<kLanes - 1>(before.upperRight, force[kUpperRight]) - force[kUp];
    complete.Put(slot, ofNextRow.Get(slot, n) - force[kTwoUp]);
    before.sum = weight;
    if (a.extraForce[0] && p < endOfCreators) before.sum = before.sum + Load3(a.extraForce, p);
    for (int k = 0; k < kKinds; ++k) before.sum = before.sum + force[k];
    before.left = force[kLeft], before.upperLeft = force[kUpperLeft];
    before.upperRight = force[kUpperRight], before.twoLeft = force[kTwoLeft];

    const std::int64_t moved = p - delay;
    if (moved < begin) continue;
    const int count = static_cast<int>(end - moved < kLanes ? end - moved : kLanes);
    outOfBounds = outOfBounds | Verlet(a, moved, count, complete.Get(slot, delay - 2 * n));
  }
  return Bits(outOfBounds);
}
