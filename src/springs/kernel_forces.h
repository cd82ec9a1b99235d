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

/// What the next block needs of a block's forces.
struct LastForces {
  Pack3 sum;  // on the block's points, by the springs that they create
  Pack3 left, up, upperRight;
};

/// The sheet is walked as one line of points, a block at a time; springs that would reach from the
/// end of a row to the start of another do not exist. A point feels the springs that it creates, and
/// then those that the points 1, 2, n - 1, n, n + 1 and 2 n farther on create: in this order, which
/// is that of creation, they are summed. So with the springs of points p come the last ones of their own row
/// for points p - 2, the last ones of the next row for points p - n - 1, and the last of all for points
/// p - 2 n, which then move. Forces read positions only, and the new ones go where the previous ones
/// were.
std::int64_t Integrate(const IntegrateArgs& a) {
  const int n = a.numWidth;
  const std::int64_t begin = std::int64_t{a.rowBegin} * n, end = std::int64_t{a.rowEnd} * n;
  const std::int64_t endOfCreators = std::int64_t{a.rowEnd + 2 < a.numHeight ? a.rowEnd + 2 : a.numHeight} * n;
  const Steps step(n);
  const int ring = ForceRingSize(n), room = ring + kGridPad;
  const auto makeRing = [&](double* start) { return ForceRing{{start, start + room, start + 2 * room}, ring}; };
  const ForceRing ofOwnRow = makeRing(a.scratch), ofNextRow = makeRing(a.scratch + 3 * room);

  // Never a negative zero: adding the zero of a spring that does not exist must not change a sum.
  const Pack3 weight = {All(0 + a.weight[0]), All(0 + a.weight[1]), All(0 + a.weight[2])};
  Mask outOfBounds = FirstLanes(0);
  BlockSprings buffers[2];
  BlockSprings *here = &buffers[0], *ahead = &buffers[1];
  // Some points too early, so that those that move are whole blocks; nobody feels the springs of these.
  const std::int64_t first = begin + 2 * n - (2 * n + kLanes - 1) / kLanes * kLanes;
  Measure(a, first, step, *here);
  LastForces last{};
  int slot = 0;
  for (std::int64_t p = first; p - 2 * n < end; p += kLanes, slot = slot + kLanes < ring ? slot + kLanes : 0) {
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

    Pack3 sum = weight;
    if (a.extraForce[0] && p < endOfCreators) sum = sum + Load3(a.extraForce, p);
    for (int k = 0; k < kKinds; ++k) sum = sum + force[k];
    ofOwnRow.Put(slot, Shift<kLanes - 2>(last.sum, sum) - Shift<kLanes - 1>(last.left, force[kLeft]) - force[kTwoLeft]);
    ofNextRow.Put(slot, ofOwnRow.Get(slot, n - 1) - Shift<kLanes - 2>(last.upperRight, force[kUpperRight]) -
                            Shift<kLanes - 1>(last.up, force[kUp]) - force[kUpperLeft]);
    const Pack3 complete = ofNextRow.Get(slot, n - 1) - force[kTwoUp];
    last = {sum, force[kLeft], force[kUp], force[kUpperRight]};

    const std::int64_t moved = p - 2 * n;
    if (moved < begin) continue;
    const int count = static_cast<int>(end - moved < kLanes ? end - moved : kLanes);
    outOfBounds = outOfBounds | Verlet(a, moved, count, complete);
  }
  return Bits(outOfBounds);
}
