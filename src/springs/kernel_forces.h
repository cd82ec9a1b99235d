// Forces and integration. Included by kernels_impl.h inside the namespace of an instruction set,
// like everything there; never elsewhere.

/// What the springs that points create pull their other ends by, kind by kind; their creators they pull as much the
/// other way, and the sums of that follow. A ring of blocks of points, ahead of which its last block stands once more.
struct alignas(64) Pulls {
  static constexpr int kSize = 8 * kLanes;
  static constexpr int kStride = kLanes + kSize;  // from axis to axis
  static constexpr int kSums = kKinds;
  static constexpr int kKindStride = 3 * kStride;
  double axes[(kKinds + 1) * kKindStride] = {};

  /// The place of a block, for Get and Put.
  double* Block(std::int64_t at) { return axes + kLanes + Slot(at, kSize); }
  static Pack3 Get(const double* block, int kind) { return LoadStrided3(block + kind * kKindStride, kStride); }
  static void Put(double* block, int kind, const Pack3& pull) {
    StoreStrided3(block + kind * kKindStride, kStride, pull);
  }
  void RepeatLastBlock() {
    for (int kind = 0; kind <= kKinds; ++kind) Put(axes, kind, Get(axes + kSize, kind));
  }
};

/// Two rings of sums of forces. Their first block stands at their end once more, so that any kLanes neighbours can be
/// read at once.
struct ForceRings {
  enum Which { kOfOwnRow, kOfNextRow };  // what they end with
  double* start;
  std::int64_t size, stride;

  Pack3 Get(Which ring, std::int64_t at) const {
    return LoadStrided3(start + 3 * ring * stride + Slot(at, size), stride);
  }
  void Put(Which ring, std::int64_t at, const Pack3& sum) const {
    double* const begin = start + 3 * ring * stride;
    const std::int64_t slot = Slot(at, size);
    StoreStrided3(begin + slot, stride, sum);
    if (slot == 0) StoreStrided3(begin + size, stride, sum);
  }
};

/// A spring whose length is under way. Roots take long: several are begun before the first is asked for.
struct BegunSpring {
  Pack3 d;  // from the other end to the creator
  Pack length;
};

/// What it pulls its other end by.
inline Pack3 PullOf(const BegunSpring& spring, Pack rest, Pack stiffness) {
  // A spring that does not exist pulls nothing, and neither does one whose ends coincide: it has no direction.
  // Other lengths are roots of numbers above 4e-324, and so above 1e-180 of any rest length.
  const Mask pulling = spring.length * All(1e180) > rest;
  return spring.d * Where(pulling, stiffness * (spring.length - rest) / spring.length);
}

/// A walk along the sheet as one line of points, a block after the other; springs that would reach from the end of a
/// row to the start of another do not exist. A point feels the springs that it creates, and then those that the points
/// 1, 2, n - 1, n, n + 1 and 2 n farther on create: in this order, which is that of creation, they are summed. So once
/// the springs of points p are known, the sums of points p - 2 end with the last ones of their own row, those of points
/// p - n - 1 with the last ones of the next row, and those of points p - 2 n are complete, and these move. Forces read
/// positions only, and the new ones go where the previous ones were.
struct IntegrateWalk {
  // The block; those of its points two rows before it, which move; and where this is.
  const double *x, *rest;
  double* previous;
  std::int64_t at = 0;  // from the first block on

  std::int64_t movesBegin, movesEnd;  // blocks whose points two rows before them move
  std::int64_t numWidth, stride, restStride;
  ForceRings sums;
  const double* extraForce[3];  // from the first block on
  Pack3 weight;
  Pack stiffness[kKinds], keep, forceToWay;
  double bound;

  double last[3 * kLanes];           // forces on points that did not move, at the end: those after the last whole block
  Mask outOfBounds = FirstLanes(0);  // points that did
};

/// Where Verlet's rule takes points.
inline Pack3 Verlet(const IntegrateWalk& w, const Pack3& x, const Pack3& previous, const Pack3& force) {
  return x + (x - previous) * w.keep + force * w.forceToWay;
}
inline Mask IsOutside(const Pack3& x, double bound) {
  return Outside(x.x, bound) | Outside(x.y, bound) | Outside(x.z, bound);
}

/// Pulls are read a point or two beside where they were written, which takes long until they have reached the cache:
/// the sums of a row lag behind by this, where the rows are that long.
constexpr int kLag = 3 * kLanes;

/// Walks on to `end`. `kCreates`: whether the points create springs.
///
/// The divider takes most of the time, and the processor looks ahead by little more than a block: so lengths are begun
/// early, and everything else is done between them.
template <bool kCreates, bool kWindy, bool kLags>
void WalkTo(std::int64_t end, IntegrateWalk& w, Pulls& pulls) {
  // In registers: what is stored meanwhile might change the walk's own.
  const double *x = w.x, *rest = w.rest;
  double* previous = w.previous;
  std::int64_t at = w.at;
  const std::int64_t n = w.numWidth, stride = w.stride, restStride = w.restStride;
  const ForceRings sums = w.sums;
  Mask outOfBounds = FirstLanes(0);
  for (; at < end; at += kLanes, x += kLanes, previous += kLanes, rest += kLanes) {
    double* const put = pulls.Block(at);
    const double* const rows[3] = {x, x - n, x - 2 * n};
    const auto otherEnd = [&](int kind) PERCALE_INLINE { return LoadStrided3(rows[-kDj[kind]] + kDi[kind], stride); };
    const Pack3 moving = otherEnd(kTwoUp), here = kCreates ? LoadStrided3(x, stride) : Zero3();

    Pack roots[kKinds];
    if constexpr (kCreates && kQuickRoots) {  // all kinds side by side, which takes many registers
      Pack squared[kKinds];
      for (int kind = 0; kind < kKinds; ++kind) squared[kind] = SquaredLength(here - otherEnd(kind));
      if (!QuickSqrt(squared, roots)) {
        for (int kind = 0; kind < kKinds; ++kind) roots[kind] = Sqrt(squared[kind]);
      }
    }
    const auto begin = [&](int kind) PERCALE_INLINE {
      BegunSpring spring;
      if constexpr (kCreates) {
        spring.d = here - otherEnd(kind);
        spring.length = kQuickRoots ? roots[kind] : Sqrt(SquaredLength(spring.d));
      }
      return spring;
    };
    const auto finish = [&](int kind, const BegunSpring& spring) PERCALE_INLINE {
      Pack3 pull = Zero3();
      if constexpr (kCreates) pull = PullOf(spring, Load(rest + kind * restStride), w.stiffness[kind]);
      Pulls::Put(put, kind, pull);
    };
    const std::int64_t lagging = kLags ? at - kLag : at;
    const double* const get = pulls.Block(lagging);
    const auto sumOwnRow = [&]() PERCALE_INLINE {
      sums.Put(ForceRings::kOfOwnRow, lagging,
               Pulls::Get(get - 2, Pulls::kSums) + Pulls::Get(get - 1, kLeft) + Pulls::Get(get, kTwoLeft));
    };
    const auto sumNextRow = [&]() PERCALE_INLINE {
      sums.Put(ForceRings::kOfNextRow, lagging,
               sums.Get(ForceRings::kOfOwnRow, lagging - (n - 1)) + Pulls::Get(get - 2, kUpperRight) +
                   Pulls::Get(get - 1, kUp) + Pulls::Get(get, kUpperLeft));
    };
    const auto move = [&]() PERCALE_INLINE {
      const Pack3 force = sums.Get(ForceRings::kOfNextRow, at - (n - 1)) + Pulls::Get(put, kTwoUp);
      if (at < w.movesBegin || at >= w.movesEnd) {
        StoreStrided3(w.last, kLanes, force);
        return;
      }
      const Pack3 next = Verlet(w, moving, LoadStrided3(previous, stride), force);
      StoreStrided3(previous, stride, next);
      outOfBounds = outOfBounds | IsOutside(next, w.bound);
    };

    // The order was tuned on pinned2.
    const BegunSpring twoUp = begin(kTwoUp);
    const BegunSpring left = begin(kLeft);
    if constexpr (kLags) sumOwnRow();
    const BegunSpring up = begin(kUp);
    finish(kTwoUp, twoUp);
    if constexpr (kLags) sumNextRow();
    const BegunSpring upperLeft = begin(kUpperLeft);
    finish(kLeft, left);
    if constexpr (kLags) move();
    const BegunSpring upperRight = begin(kUpperRight);
    finish(kUp, up);
    const BegunSpring twoLeft = begin(kTwoLeft);
    finish(kUpperLeft, upperLeft);
    finish(kUpperRight, upperRight);
    finish(kTwoLeft, twoLeft);
    Pack3 sum = w.weight;
    if constexpr (kWindy) sum = sum + Load3(w.extraForce, at);
    for (int kind = 0; kind < kKinds; ++kind) sum = sum - Pulls::Get(put, kind);
    Pulls::Put(put, Pulls::kSums, sum);
    if constexpr (!kLags) sumOwnRow(), sumNextRow(), move();
    if (Slot(at + kLanes, Pulls::kSize) == 0) pulls.RepeatLastBlock();
  }
  w.x = x, w.rest = rest, w.previous = previous, w.at = at;
  w.outOfBounds = w.outOfBounds | outOfBounds;
}

/// The whole walk: to the end of the points that create springs, and then on.
template <bool kLags>
void Walk(std::int64_t endOfCreators, std::int64_t end, bool windy, IntegrateWalk& w) {
  Pulls pulls;
  if (windy) {
    WalkTo<true, true, kLags>(endOfCreators, w, pulls);
  } else {
    WalkTo<true, false, kLags>(endOfCreators, w, pulls);
  }
  WalkTo<false, false, kLags>(end, w, pulls);
}

std::int64_t Integrate(const IntegrateArgs& a) {
  const std::int64_t n = a.numWidth, begin = a.rowBegin * n, end = a.rowEnd * n;
  const std::int64_t endOfCreators = (a.rowEnd + 2 < a.numHeight ? a.rowEnd + 2 : a.numHeight) * n;
  // Some points too early, so that those that move are whole blocks; nobody feels the springs of these.
  const std::int64_t first = begin + 2 * n - (2 * n + kLanes - 1) / kLanes * kLanes;
  const auto beyond = static_cast<int>((end - begin) % kLanes);  // points, after the last whole block
  const std::int64_t lastBlock = end - beyond;
  const bool windy = a.extraForce[0] != nullptr;

  IntegrateWalk w;
  w.x = a.x + first, w.rest = a.rest + first, w.previous = a.previous + first - 2 * n;
  w.movesBegin = begin + 2 * n - first, w.movesEnd = lastBlock + 2 * n - first;
  w.numWidth = n, w.stride = a.stride, w.restStride = a.restStride;
  const std::int64_t ringSize = ForceRingSize(a.numWidth);
  w.sums = {a.scratch, ringSize, ringSize + kGridPad};
  for (int axis = 0; axis < 3; ++axis) w.extraForce[axis] = windy ? a.extraForce[axis] + first : nullptr;
  // Never a negative zero: adding the zero of a spring that does not exist must not change a sum.
  w.weight = {All(0 + a.weight[0]), All(0 + a.weight[1]), All(0 + a.weight[2])};
  for (int kind = 0; kind < kKinds; ++kind) w.stiffness[kind] = All(a.stiffness[kind]);
  w.keep = All(a.keep), w.forceToWay = All(a.forceToWay), w.bound = a.bound;

  // Of a block that moves, sums end with those of the next row up to n - 1 points before the block that is walked.
  if (n - 1 >= kLag + kLanes) {
    Walk<true>(endOfCreators - first, end + 2 * n - first, windy, w);
  } else {
    Walk<false>(endOfCreators - first, end + 2 * n - first, windy, w);
  }

  // What is beyond the last row belongs to others.
  const double* const x[3] = {a.x, a.x + a.stride, a.x + 2 * a.stride};
  double* const previous[3] = {a.previous, a.previous + a.stride, a.previous + 2 * a.stride};
  const Pack3 next = Verlet(w, LoadFirst3(x, lastBlock, beyond), LoadFirst3(previous, lastBlock, beyond),
                            LoadStrided3(w.last, kLanes));
  StoreFirst3(previous, lastBlock, next, beyond);
  return Bits(w.outOfBounds | (FirstLanes(beyond) & IsOutside(next, a.bound)));
}
