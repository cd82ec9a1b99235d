// Provot's limit on the length of springs. Included by kernels_impl.h inside the namespace of an
// instruction set, like everything there; never elsewhere.

/// Spreads eight bits to the lowest of eight bytes each.
inline std::uint64_t BytePerBit(unsigned bits) {
  const std::uint64_t apart = bits * std::uint64_t{0x0101010101010101} & 0x8040201008040201;
  return (apart + 0x7f7f7f7f7f7f7f7f) >> 7 & 0x0101010101010101;
}

/// A row of points relative to another point, in float. Around it stands room for a block.
struct RelativeRow {
  float* axes;
  std::int64_t stride;

  FloatPack3 Get(std::int64_t i) const {
    return {LoadFloats(axes + i), LoadFloats(axes + stride + i), LoadFloats(axes + 2 * stride + i)};
  }
  void Put(std::int64_t i, const FloatPack3& x) const {
    StoreFloats(axes + i, x.x), StoreFloats(axes + stride + i, x.y), StoreFloats(axes + 2 * stride + i, x.z);
  }
};

/// Springs are measured in float, eight at a time. Positions are read beside where they were put, which takes long
/// until they have reached the cache: first those of the row are put.
std::int64_t MarkLongSprings(const LongSpringsArgs& a) {
  const std::int64_t n = a.numWidth, end = a.rowEnd * n, stride = MarkScratch(a.numWidth) / 9;
  RelativeRow rows[3];  // this one, and those above it
  for (int row = 0; row < 3; ++row) rows[row] = {a.scratch + 3 * row * stride + kFloatLanes, stride};
  // Springs to rows that do not exist are not longer than anything.
  const FloatPack nowhere = AllFloats(NAN);
  if (a.rowBegin < 2) {
    for (std::int64_t i = 0; i < n + kFloatLanes; i += kFloatLanes) {
      for (int row = 0; row < 2; ++row) rows[row].Put(i, {nowhere, nowhere, nowhere});
    }
  }
  FloatPack farthest = AllFloats(0);
  std::uint64_t any = 0;
  for (std::int64_t j = a.rowBegin < 2 ? 0 : a.rowBegin - 2; j < a.rowEnd; ++j) {
    const RelativeRow here = rows[2], up = rows[0], twoUp = rows[1];
    rows[0] = here, rows[1] = up, rows[2] = twoUp;
    for (std::int64_t i = 0, p = j * n; i < n; i += kFloatLanes, p += kFloatLanes) {
      here.Put(i, {FloatsBefore(a.origin[0], a.x[0] + p), FloatsBefore(a.origin[1], a.x[1] + p),
                   FloatsBefore(a.origin[2], a.x[2] + p)});
    }
    here.Put(n, {AllFloats(0), AllFloats(0), AllFloats(0)});
    if (j < a.rowBegin) continue;

    for (std::int64_t i = 0, p = j * n; i < n; i += kFloatLanes, p += kFloatLanes) {
      const FloatPack3 x = here.Get(i);
      const float* const nearSquared = a.nearSquared + i;
      const auto isNear = [&](const FloatPack3& other, int kind) PERCALE_INLINE {
        return SquaredDistance(x, other) > LoadFloats(nearSquared + kind * a.nearStride);
      };
      const FloatMask near[kKinds] = {isNear(here.Get(i - 1), kLeft),    isNear(up.Get(i), kUp),
                                      isNear(up.Get(i - 1), kUpperLeft), isNear(up.Get(i + 1), kUpperRight),
                                      isNear(here.Get(i - 2), kTwoLeft), isNear(twoUp.Get(i), kTwoUp)};
      std::uint64_t marks = 0;
      if (Bits(((near[0] | near[1]) | (near[2] | near[3])) | (near[4] | near[5])) != 0) {
        for (int kind = 0; kind < kKinds; ++kind) marks |= BytePerBit(Bits(near[kind])) << kind;
        any = 1;
      }
      farthest = Greatest(farthest, Greatest(Greatest(Size(x.x), Size(x.y)), Size(x.z)));
      // What is beyond the row comes after it, and what is beyond the last row belongs to others.
      if (end - p >= kFloatLanes) {
        memcpy(a.nearKinds + p, &marks, kFloatLanes);
      } else {
        memcpy(a.nearKinds + p, &marks, static_cast<std::size_t>(end - p));
      }
    }
  }
  const bool farAway = AtMost(farthest, a.farthest) != (1u << kFloatLanes) - 1;
  return (any != 0 ? kSomeAreNear : std::int64_t{0}) | (farAway ? kSomeAreFarAway : std::int64_t{0});
}

GreatestStretchResult GreatestStretch(const GreatestStretchArgs& a) {
  const Steps step(a.numWidth);
  GreatestStretchResult result{0, 0};
  for (std::int64_t p = 0; p < a.pointCount; p += kLanes) {
    const Pack3 x = Load3(a.x, p);
    Pack squared[kKinds], restSquared[kKinds];
    Mask longer = FirstLanes(0);
    for (int kind = 0; kind < kKinds; ++kind) {
      const Pack rest = Load(a.rest[kind] + p);  // kNoSpringRest: the ratio is zero
      squared[kind] = SquaredLength(Load3(a.x, p + step[kind]) - x);
      restSquared[kind] = rest * rest;
      longer = longer | (squared[kind] > restSquared[kind] * All(result.squaredRatio * (1 - 1e-12)));
    }
    if (Bits(longer) == 0) continue;  // surely not: without a quotient
    Pack ratio = All(0);
    for (int kind = 0; kind < kKinds; ++kind) ratio = Max(ratio, squared[kind] / restSquared[kind]);
    double lanes[kLanes];
    Store(lanes, ratio);
    for (int lane = 0; lane < kLanes; ++lane) {
      if (lanes[lane] > result.squaredRatio) result = {lanes[lane], p + lane};
    }
  }
  return result;
}

double ElasticEnergy(const ElasticEnergyArgs& a) {
  // Eight sums side by side, whatever the instruction set holds at once: the same bits on all.
  constexpr int kSums = 8;
  static_assert(kSums % kLanes == 0 && kSums <= kGridPad);
  const Steps step(a.numWidth);
  Pack sums[kSums / kLanes];
  for (Pack& sum : sums) sum = All(0);
  for (std::int64_t p = 0; p < a.pointCount; p += kSums) {
    for (int part = 0; part < kSums / kLanes; ++part) {
      const std::int64_t at = p + part * kLanes;
      const Pack3 x = Load3(a.x, at);
      for (int kind = 0; kind < kKinds; ++kind) {
        const Pack rest = Load(a.rest[kind] + at);
        const Pack longer = Sqrt(SquaredLength(Load3(a.x, at + step[kind]) - x)) - rest;
        sums[part] = sums[part] + Where(All(kNoSpringRest) > rest, All(0.5 * a.stiffness[kind]) * longer * longer);
      }
    }
  }
  double lanes[kSums];
  for (int part = 0; part < kSums / kLanes; ++part) Store(lanes + part * kLanes, sums[part]);
  double energy = 0;
  for (const double lane : lanes) energy += lane;
  return energy;
}

/// One sheet's sweep over all springs in creation order.
struct StrainSweep {
  const StrainArgs& a;
  const Steps step;
  std::int64_t limited = 0;

  /// Springs at an end of a spring that come after it: the points that create them, counted from the
  /// one that creates it, and the bits of their kinds.
  struct LaterSprings {
    int count = 0;
    std::int64_t creator[kKinds];
    std::uint8_t bit[kKinds];
  };
  LaterSprings atCreator, atOther[kKinds];

  explicit StrainSweep(const StrainArgs& args) : a(args), step(a.numWidth) {
    atCreator = Later(0);
    for (int kind = 0; kind < kKinds; ++kind) atOther[kind] = Later(step[kind]);
  }

  /// Those at the point `end`.
  LaterSprings Later(std::int64_t end) const {
    LaterSprings later;
    for (int kind = 0; kind < kKinds; ++kind) {
      if (end - step[kind] <= 0) continue;
      later.creator[later.count] = end - step[kind];
      later.bit[later.count++] = static_cast<std::uint8_t>(1u << kind);
    }
    return later;
  }

  /// The springs that a point creates and that are marked. Returns whether marks of other points were added.
  bool Visit(std::int64_t p) {
    double px = a.x[0][p], py = a.x[1][p], pz = a.x[2][p];
    const bool fixedP = a.fixed[p] != 0;
    bool moved = false, marked = false;
    // Kinds ascend; marks that come while the loop runs are of later ones.
    for (unsigned kinds = a.marks[p]; kinds != 0;) {
      const int kind = LowestBit(kinds);
      kinds &= kinds - 1;
      const std::int64_t q = p + step[kind];
      const double dx = a.x[0][q] - px, dy = a.x[1][q] - py, dz = a.x[2][q] - pz;
      const double squared = dx * dx + dy * dy + dz * dz;
      const double limit = a.limit * a.rest[kind][p], limitSquared = limit * limit;
      if (squared < limitSquared * (1 - 1e-12)) continue;  // surely short enough
      const bool fixedQ = a.fixed[q] != 0;
      if (fixedP && fixedQ) continue;
      const double length = Sqrt(squared);
      if (squared < limitSquared * (1 + 1e-12) && length <= limit) continue;  // else surely too long
      // Shares are powers of two or zero: what they scale is rounded alike.
      const double shareP = fixedP ? 0 : fixedQ ? 1 : 0.5, shareQ = fixedQ ? 0 : 1 - shareP;
      const double factor = (length - limit) / (fixedP || fixedQ ? length : 2 * length);
      const double ex = dx * factor, ey = dy * factor, ez = dz * factor;
      if (!fixedP) px += ex, py += ey, pz += ez;
      if (!fixedQ) a.x[0][q] -= ex, a.x[1][q] -= ey, a.x[2][q] -= ez;
      ++limited;
      moved = true;
      if (MovesFar(p, shareP * (length - limit))) {
        kinds |= a.kinds[p] & (~0u << (kind + 1));
        Mark(p, atCreator);
        marked = true;
      }
      if (MovesFar(q, shareQ * (length - limit))) {
        Mark(p, atOther[kind]);
        marked = true;
      }
    }
    if (moved) a.x[0][p] = px, a.x[1][p] = py, a.x[2][p] = pz;
    return marked;
  }

  /// Adds to what a point was moved by [m]. Returns whether that leads beyond its budget: once, since then all its
  /// later springs are marked.
  bool MovesFar(std::int64_t p, double way) {
    const float before = a.moved[p];
    a.moved[p] = before + static_cast<float>(way);
    return a.moved[p] > a.budget && before <= a.budget;
  }

  /// Marks springs that come after one that p creates. Where there is none, `kinds` has no bit.
  void Mark(std::int64_t p, const LaterSprings& later) {
    for (int i = 0; i < later.count; ++i) {
      const std::int64_t creator = p + later.creator[i];
      a.marks[creator] = static_cast<std::uint8_t>(a.marks[creator] | (a.kinds[creator] & later.bit[i]));
    }
  }
};

/// A spring that was not near its limit, and whose ends did not move far since, is not too long: the
/// sweep visits the others.
std::int64_t LimitStrain(const StrainArgs& a) {
  StrainSweep sweep(a);
  for (std::int64_t begin = 0; begin < a.pointCount; begin += kMarkBlock) {
    for (std::uint64_t todo = NonzeroBytes(a.marks + begin); todo != 0;) {
      const int at = LowestBit(todo);
      todo &= todo - 1;
      if (sweep.Visit(begin + at)) todo = NonzeroBytes(a.marks + begin) & (~std::uint64_t{1} << at);
    }
  }
  return sweep.limited;
}
