// Boxes of the spatial map, and points that push each other apart. Included by kernels_impl.h inside
// the namespace of an instruction set, like everything there; never elsewhere.

constexpr int kIndexBits = 21;  // of a key, for each axis
constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << kIndexBits) - 1;
constexpr double kIndexEnd = 0x1p20;  // indices beyond it, or below its negative, come round
constexpr int kPartBits = 30;         // of a coordinate in boxes after the point
/// Adding this to a number of at most 2^51 rounds it to a whole one, which then stands in the low bits.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52
constexpr std::uint64_t kRounderTop = 0x433;     // its sign and exponent, and those of such sums

/// The coordinates of a block of points along one axis, in parts of a box from the rounder on: off by at
/// most one part.
inline Words Parts(const double* x, Pack perMetre) {
  return WordsOf(Load(x) * perMetre + All(kRounder));
}

/// floor(coordinate / size) in the low bits of a key.
inline std::uint64_t ExactIndex(double coordinate, double size) {
  const double rounded = Floor(coordinate / size) + kRounder;
  std::uint64_t bits;
  memcpy(&bits, &rounded, sizeof bits);
  return bits & kIndexMask;
}

/// The floor of a point's coordinates in boxes, as a key.
inline std::uint64_t ExactKey(const BoxKeyArgs& a, int p) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) key |= ExactIndex(a.x[axis][p], a.boxSize[axis]) << kIndexBits * axis;
  return key;
}
/// A side of a box, in whole units of places.
inline double UnitsOf(const BoxKeyArgs& a, int axis) {
  return Floor(a.boxSize[axis] / a.boxSize[2] * (1 << kPlaceBits));
}
/// Where it is within that box.
inline std::uint64_t ExactPlace(const BoxKeyArgs& a, int p) {
  std::uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = a.x[axis][p] / a.boxSize[axis], end = UnitsOf(a, axis);
    double units = (at - Floor(at)) * end;  // `end`, where the difference rounds to one
    units = units < end ? units : end - 1;
    units = units > 0 ? units : 0;  // too far out it may be no number
    place |= static_cast<std::uint64_t>(units) << 16 * axis;
  }
  return place;
}
/// Whether a point is so far out that its indices come round.
inline bool Wraps(const BoxKeyArgs& a, int p) {
  for (int axis = 0; axis < 3; ++axis) {
    const double at = a.x[axis][p], end = kIndexEnd * a.boxSize[axis];
    if (!(at < end && at > -end)) return true;
  }
  return false;
}

std::int64_t BoxKeys(const BoxKeyArgs& a) {
  std::int64_t changed = 0;
  Pack perMetre[3];
  for (int axis = 0; axis < 3; ++axis) {
    perMetre[axis] = All(static_cast<double>(std::uint64_t{1} << kPartBits) / a.boxSize[axis]);
  }
  std::uint64_t sides = 0;  // of a box, in units
  for (int axis = 0; axis < 3; ++axis) sides |= static_cast<std::uint64_t>(UnitsOf(a, axis)) << 16 * axis;
  for (int begin = 0; begin < a.count; begin += kLanes) {
    std::uint64_t keys[kLanes];
    unsigned changes = 0, doubts = 0;  // a bit for each point whose key changed, or may have
    if (begin + kLanes <= a.count) {
      const Words x = Parts(a.x[0] + begin, perMetre[0]), y = Parts(a.x[1] + begin, perMetre[1]),
                  z = Parts(a.x[2] + begin, perMetre[2]);
      const Words key = (Down<kPartBits>(x) & AllWords(kIndexMask)) |
                        (Down<kPartBits - kIndexBits>(y) & AllWords(kIndexMask << kIndexBits)) |
                        (Up<2 * kIndexBits - kPartBits>(z) & AllWords(kIndexMask << 2 * kIndexBits));
      const Words inBox = Quarters(x, y, z);  // in 2^-16 of its sides
      StoreWords(a.place + begin, TimesQuarters(inBox, AllWords(sides)));
      const Words top = AllWords(kRounderTop << 52);  // sums that do not have it are beyond 2^51 parts
      const Words beyond = Down<52>((x ^ top) | (y ^ top) | (z ^ top));
      const Words doubtful = beyond | ExtremeQuarters(inBox);  // may be on the other side of a whole number
      changes = Differ((key ^ LoadWords(a.key + begin)) | doubtful, AllWords(0));
      if (changes == 0) continue;
      doubts = Differ(doubtful, AllWords(0));
      StoreWords(keys, key);
    } else {
      changes = doubts = (1u << (a.count - begin)) - 1;
    }
    for (; changes != 0; changes &= changes - 1) {
      const int lane = LowestBit(changes), p = begin + lane;
      const bool doubtful = (doubts >> lane & 1) != 0;
      const std::uint64_t key = doubtful ? ExactKey(a, p) : keys[lane];
      if (doubtful) a.place[p] = ExactPlace(a, p);
      if (Wraps(a, p)) *a.wraps = 1;
      if (key == a.key[p]) continue;
      a.key[p] = key;
      a.changed[changed++] = a.firstPoint + p;
    }
  }
  return changed;
}

/// Squares of distances between places of points, with room for what these are off: points that are not below are
/// farther apart than ...
struct Reach {
  std::int32_t push;    ///< ... those that push each other.
  std::int32_t deep;    ///< A bucket without a pair as near is shallow: points move little there,
  std::int32_t slight;  ///< and only those that are as near may push each other after others have moved.
  std::int32_t far;     ///< The same for any bucket.
};

/// A bucket whose points' distances are looked at.
struct BucketPlaces {
  static constexpr int kMost = 64;  // members
  const std::int32_t* members;
  int count;
  // Behind the last stand the first once more, and then what is far from all.
  std::int32_t xy[2 * kMost], z[2 * kMost];

  Places Block(int m) const { return LoadPlaces(xy + m, z + m); }
  void PutBlock(int m, Places places) { StorePlaces(xy + m, z + m, places); }

  /// Returns false where no point pushes another, as is seen at first sight: then none moves.
  bool Take(const BucketArgs& a, const std::int32_t* bucket, int size, std::int32_t push);
};

inline bool BucketPlaces::Take(const BucketArgs& a, const std::int32_t* bucket, int size, std::int32_t push) {
  members = bucket, count = size;
  // Most buckets are few points that lie flat, three by three.
  const auto gather = [&](int m) PERCALE_INLINE { return FirstPlaces(count - m, GatherPlaces(a.place, members + m)); };
  const Places points = gather(0);
  if (count <= kPlaceLanes + 1) {
    Ints least = Least(Least(SquaredDistance(points, Turn<1>(points)), SquaredDistance(points, Turn<2>(points))),
                       Least(SquaredDistance(points, Turn<3>(points)), SquaredDistance(points, Turn<4>(points))));
    // The ninth, or what is as far from all as the lanes that FirstPlaces fills.
    const std::uint64_t beyond = count > kPlaceLanes ? 0 : std::uint64_t{0xe000} << 48;
    least = Least(least, SquaredDistance(points, AllPlaces(a.place[members[kPlaceLanes]] | beyond)));
    if (Below(least, push) == 0) return false;
  }
  PutBlock(0, points);
  int end = kPlaceLanes;
  for (; end < count; end += kPlaceLanes) PutBlock(end, gather(end));
  // The last block first: it is read before others are put over its end.
  for (int m = end - kPlaceLanes; m >= 0; m -= kPlaceLanes) PutBlock(count + m, Block(m));
  return true;
}

/// Which points of a bucket may come too close to which others while they move.
struct NearPoints {
  const std::int32_t* members;
  std::uint64_t near[BucketPlaces::kMost];  // per member a bit for each other that is near it
  std::uint64_t todo = 0;                   // a bit for each that is near others, and did not move yet

  /// Blocks are unrolled, by the bucket's number of them, since loops of many lengths would be foretold badly: a
  /// bucket that has more than `blocks` is left to the next.
  template <int blocks = 1>
  void Find(const BucketPlaces& bucket, Reach reach);
};

template <int blocks>
inline void NearPoints::Find(const BucketPlaces& bucket, Reach reach) {
  if constexpr (blocks < BucketPlaces::kMost / kPlaceLanes) {
    if (bucket.count > blocks * kPlaceLanes) return Find<blocks + 1>(bucket, reach);
  }
  const int count = bucket.count;
  Places places[blocks];
  for (int b = 0; b < blocks; ++b) places[b] = bucket.Block(b * kPlaceLanes);

  const std::uint64_t all = ~std::uint64_t{0} >> (BucketPlaces::kMost - count);
  std::uint64_t found = 0;
  const auto look = [&](std::int32_t within) PERCALE_INLINE {
    found = 0;
    Ints least = AllInts(reach.far);
    // Each point and the one `turn` members farther on, the first after the last, until all have met.
    for (int turn = 1; turn <= count / 2; ++turn) {
      std::uint64_t bits = 0;
      for (int b = 0; b < blocks; ++b) {
        const int m = b * kPlaceLanes;
        const Ints squares = SquaredDistance(places[b], bucket.Block(m + turn));
        bits |= std::uint64_t{Below(squares, within)} << m;
        least = Least(least, squares);
      }
      bits &= all;
      found |= bits | bits << turn | bits >> (count - turn);
    }
    return Below(least, reach.deep) != 0;
  };
  std::int32_t within = reach.slight;
  if (look(within)) look(within = reach.far);
  members = bucket.members;
  todo = found & all;
  for (std::uint64_t left = todo; left != 0; left &= left - 1) {
    const int m = LowestBit(left);
    const Places point = AllPlaces(bucket.xy + m, bucket.z + m);
    std::uint64_t bits = 0;
    for (int b = 0; b < blocks; ++b) {
      bits |= std::uint64_t{Below(SquaredDistance(point, places[b]), within)} << b * kPlaceLanes;
    }
    near[m] = bits & all & ~(std::uint64_t{1} << m);
  }
}

/// The sum of pushes on one point.
struct Push {
  double x = 0, y = 0, z = 0;
  int count = 0;

  /// Adds the push of a point at distance vector d, if it is nearer than `apart`.
  void Add(double dx, double dy, double dz, double apart) {
    const double distance = Sqrt(dx * dx + dy * dy + dz * dz);
    if (distance > apart) return;
    ++count;
    if (distance > 0) {
      const double factor = (apart - distance) / distance;
      x += dx * factor;
      y += dy * factor;
      z += dz * factor;
    } else {
      y += apart;  // points that coincide part along +y
    }
  }
};

/// Moves a point by what the points `others` push, in this order. Returns how many do.
inline int PushApart(const BucketArgs& a, std::int32_t point, const std::int32_t* others, int count) {
  const double x = a.x[0][point], y = a.x[1][point], z = a.x[2][point];
  Push push;
  for (int i = 0; i < count; ++i) {
    const std::int32_t other = others[i];
    push.Add(x - a.x[0][other], y - a.x[1][other], z - a.x[2][other], a.thickness[point] + a.thickness[other]);
  }
  if (push.count > 0 && !a.fixed[point]) {
    const double share = push.count * a.stepsPerFrame;
    a.x[0][point] = x + push.x / share;
    a.x[1][point] = y + push.y / share;
    a.x[2][point] = z + push.z / share;
  }
  return push.count;
}

/// A bucket whose points may be anywhere, or are many: each looks at all others.
std::int64_t SeparateMany(const BucketArgs& a, const std::int32_t* members, int count, double farthest) {
  const Pack squared = All(farthest * farthest * (1 + 1e-12));  // squares round: rather look twice
  double* x[3];
  for (int axis = 0; axis < 3; ++axis) {
    x[axis] = a.scratch + axis * (count + kLanes);
    for (int m = 0; m < count; ++m) x[axis][m] = a.x[axis][members[m]];
    Store(x[axis] + count, All(1e300));  // its square is infinite
  }
  std::int64_t contacts = 0;
  for (int m = 0; m < count; ++m) {
    const Pack3 point = {All(x[0][m]), All(x[1][m]), All(x[2][m])};
    int near = 0;
    for (int base = 0; base < count; base += kLanes) {
      for (unsigned bits = Bits(SquaredLength(point - Load3(x, base)) <= squared); bits != 0; bits &= bits - 1) {
        const int other = base + LowestBit(bits);
        if (other != m) a.others[near++] = members[other];
      }
    }
    contacts += PushApart(a, members[m], a.others, near);
    for (int axis = 0; axis < 3; ++axis) x[axis][m] = a.x[axis][members[m]];
  }
  return contacts;
}

/// Buckets whose near points push each other, one per lane. Within a bucket points go in order, each
/// waits for the one before it; points of different buckets go side by side.
struct PushLanes {
  NearPoints buckets[kLanes];
  Pack pushes = All(0);  // per lane

  /// Moves the next point of every bucket that has one left. Returns how many pushes that took beside those
  /// that it adds to `pushes`.
  std::int64_t Turn(const BucketArgs& a);
};

inline std::int64_t PushLanes::Turn(const BucketArgs& a) {
  // Lanes that have none left take a point that no other thread has: the first lane was filled first.
  const std::int32_t* members[kLanes];
  std::uint64_t itself[kLanes], others[kLanes], left[kLanes];  // bits
  std::int32_t point[kLanes];
  int most = 0, total = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    NearPoints& bucket = buckets[lane];
    const bool any = bucket.todo != 0;
    const int m = any ? LowestBit(bucket.todo) : 0;
    bucket.todo &= bucket.todo - 1;
    members[lane] = any ? bucket.members : buckets[0].members;
    itself[lane] = std::uint64_t{1} << m;
    others[lane] = left[lane] = any ? bucket.near[m] : 0;
    point[lane] = members[lane][m];
    const int count = BitCount(others[lane]);
    most = count > most ? count : most;
    total += count;
  }

  const Pack3 x = Gather3(a.x, point);
  Pack3 sum = Zero3();
  Pack pushed = All(0);
  int same = 0;
  for (int k = 0; k < most; ++k) {
    std::int32_t other[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      other[lane] = members[lane][LowestBit(left[lane] != 0 ? left[lane] : itself[lane])];
      left[lane] &= left[lane] - 1;
    }
    const Pack3 d = x - Gather3(a.x, other);
    const Pack distance = Sqrt(SquaredLength(d));
    const Pack apart = a.sameThickness ? All(a.greatestApart) : Gather(a.thickness, point) + Gather(a.thickness, other);
    const Mask valid = distance > All(0);  // else it is the point itself, or one that coincides with it
    same += kLanes - BitCount(Bits(valid));
    const Mask push = valid & (distance <= apart);
    sum = sum + d * Where(push, (apart - distance) / distance);
    pushed = pushed + Where(push, All(1));
  }
  if (same != most * kLanes - total) {  // some coincide
    std::int64_t contacts = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      std::int32_t near[BucketPlaces::kMost];
      int count = 0;
      for (std::uint64_t bits = others[lane]; bits != 0; bits &= bits - 1)
        near[count++] = members[lane][LowestBit(bits)];
      contacts += PushApart(a, point[lane], near, count);
    }
    return contacts;
  }
  pushes = pushes + pushed;
  const Mask moves = pushed > All(0);
  const Pack share = pushed * All(a.stepsPerFrame);
  const Pack3 to = Select(moves, {x.x + sum.x / share, x.y + sum.y / share, x.z + sum.z / share}, x);
  double lanes[3][kLanes];
  Store(lanes[0], to.x), Store(lanes[1], to.y), Store(lanes[2], to.z);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (others[lane] == 0 || a.fixed[point[lane]]) continue;
    for (int axis = 0; axis < 3; ++axis) a.x[axis][point[lane]] = lanes[axis][lane];
  }
  return 0;
}

constexpr double kDeepShare = 0.85;  // of what points keep apart; tuned on selfCollision

std::int64_t SeparateBuckets(const BucketArgs& a) {
  // No point moves farther than a part in stepsPerFrame of the distance that it keeps: farther pairs than that
  // stay apart. Where no two are nearer than a share of that distance, others come nearer by some way w at most,
  // and none moves by more than (distance (1 - share) + w) / stepsPerFrame, which is w for the w below.
  const double farthest = a.greatestApart * (1 + 1 / a.stepsPerFrame);
  const double slight = a.stepsPerFrame > 1 ? (1 - kDeepShare) / (a.stepsPerFrame - 1) : 1;
  const auto inUnits = [&](double distance) {
    const double units = distance / a.boxSize * (1 << kPlaceBits) + kPlaceError * Sqrt(3) + 1;
    constexpr double kAll = 1 << 2 * (kPlaceBits + 1);  // above the square of a box's diagonal
    return static_cast<std::int32_t>(units * units < kAll ? units * units : kAll);
  };
  const Reach reach = {inUnits(a.greatestApart), inUnits(kDeepShare * a.greatestApart),
                       inUnits(a.greatestApart * (1 + slight)), inUnits(farthest)};
  const int mostNear = a.place != nullptr ? BucketPlaces::kMost : 0;
  std::int64_t contacts = 0;
  PushLanes lanes;
  // What was just written reaches the cache only later: distances are looked at when the next bucket is gathered.
  BucketPlaces taken[2];
  int current = 0, bucket = a.bucketBegin;
  const auto take = [&](BucketPlaces& places) {  // the next bucket whose points may be near each other
    while (bucket < a.bucketEnd) {
      const std::int32_t* members = a.members + a.first[bucket];
      const int count = a.count[bucket++];
      if (count < 2) continue;
      if (count > mostNear) {
        contacts += SeparateMany(a, members, count, farthest);
      } else if (places.Take(a, members, count, reach.push)) {
        return true;
      }
    }
    return false;
  };
  bool has = take(taken[current]);
  const auto fill = [&](NearPoints& lane) {  // with the next bucket that has near points
    while (has) {
      const BucketPlaces& places = taken[current];
      current = 1 - current;
      has = take(taken[current]);
      lane.Find(places, reach);
      if (lane.todo != 0) return true;
    }
    return false;
  };
  for (bool any = true; any;) {
    any = false;
    for (NearPoints& lane : lanes.buckets) any |= lane.todo != 0 || fill(lane);
    if (any) contacts += lanes.Turn(a);
  }
  double pushes[kLanes];
  Store(pushes, lanes.pushes);
  for (const double count : pushes) contacts += static_cast<std::int64_t>(count);
  return contacts;
}
