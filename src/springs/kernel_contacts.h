// Boxes of the spatial map, and points that push each other apart. Included by kernels_impl.h inside
// the namespace of an instruction set, like everything there; never elsewhere.

constexpr int kIndexBits = 21;  // of a key, for each axis
constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << kIndexBits) - 1;
constexpr double kIndexEnd = 0x1p20;  // indices beyond it, or below its negative, come round
constexpr int kPartBits = 30;         // of a coordinate in boxes after the point
constexpr std::uint64_t kPartMask = (std::uint64_t{1} << kPartBits) - 1;
/// Adding this to a number of at most 2^51 rounds it to a whole one, which then stands in the low bits.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52
constexpr std::uint64_t kRounderTop = 0x433;     // its sign and exponent, and those of such sums

/// The coordinates of a block of points along one axis, in parts of a box from the rounder on: off by at
/// most one part.
inline Words Parts(const double* x, Pack perMetre) {
  return WordsOf(Load(x) * perMetre + All(kRounder));
}
/// Whether the exact coordinate may be on the other side of a whole number.
inline unsigned IsDoubtful(Words parts) {
  return Below((parts + AllWords(1)) & AllWords(kPartMask), AllWords(3));
}
inline Words Index(Words parts) {
  return Down<kPartBits>(parts) & AllWords(kIndexMask);
}

/// floor(coordinate / size) in the low bits of a key.
inline std::uint64_t ExactIndex(double coordinate, double size) {
  const double rounded = Floor(coordinate / size) + kRounder;
  std::uint64_t bits;
  memcpy(&bits, &rounded, sizeof bits);
  return bits & kIndexMask;
}

std::int64_t BoxKeys(const BoxKeyArgs& a) {
  std::int64_t changed = 0;
  Pack perMetre[3];
  for (int axis = 0; axis < 3; ++axis) {
    perMetre[axis] = All(static_cast<double>(std::uint64_t{1} << kPartBits) / a.boxSize[axis]);
  }
  for (int begin = 0; begin < a.count; begin += kLanes) {
    unsigned look = 0;  // a bit for each point whose key may have changed
    if (begin + kLanes <= a.count) {
      const Words x = Parts(a.x[0] + begin, perMetre[0]), y = Parts(a.x[1] + begin, perMetre[1]),
                  z = Parts(a.x[2] + begin, perMetre[2]);
      const Words key = Index(x) | Up<kIndexBits>(Index(y)) | Up<2 * kIndexBits>(Index(z));
      const Words top = AllWords(kRounderTop << 52);  // sums that do not have it are beyond 2^51 parts
      look = IsDoubtful(x) | IsDoubtful(y) | IsDoubtful(z);
      look |= Differ(Down<52>((x ^ top) | (y ^ top) | (z ^ top)), AllWords(0));
      look |= Differ(key, LoadWords(a.key + begin));
    } else {
      look = (1u << (a.count - begin)) - 1;
    }
    for (; look != 0; look &= look - 1) {
      const int p = begin + LowestBit(look);
      std::uint64_t key = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double at = a.x[axis][p], size = a.boxSize[axis];
        key |= ExactIndex(at, size) << kIndexBits * axis;
        if (!(at < kIndexEnd * size && at > -kIndexEnd * size)) *a.wraps = 1;
      }
      if (key == a.key[p]) continue;
      a.key[p] = key;
      a.changed[changed++] = a.firstPoint + p;
    }
  }
  return changed;
}

/// Which points of a bucket may come too close to which others while they move.
struct NearPoints {
  static constexpr int kMost = 64;
  const std::int32_t* members;
  std::uint64_t todo;         // a bit for each member that is near another
  std::uint64_t near[kMost];  // per member a bit for every other that is near it

  bool Find(const BucketArgs& a, const std::int32_t* bucketMembers, int count, float squared);
};

/// Returns whether there are any.
inline bool NearPoints::Find(const BucketArgs& a, const std::int32_t* bucketMembers, int count, float squared) {
  float x[3][kMost];  // relative to the first
  const auto gather = [&](int m) {
    for (int axis = 0; axis < 3; ++axis) {
      GatherFloats(a.x[axis], bucketMembers + m, count - m, a.x[axis][bucketMembers[0]], x[axis] + m);
    }
  };
  const auto block = [&](int m) {
    return FloatPack3{LoadFloats(x[0] + m), LoadFloats(x[1] + m), LoadFloats(x[2] + m)};
  };
  const auto alone = [&](int m) { return FloatPack3{AllFloats(x[0][m]), AllFloats(x[1][m]), AllFloats(x[2][m])}; };
  const auto anyWithin = [&](const FloatPack3& points) {
    return Within(points, Turn<1>(points), squared) | Within(points, Turn<2>(points), squared) |
           Within(points, Turn<3>(points), squared) | Within(points, Turn<4>(points), squared);
  };

  // Most buckets are few points that lie flat, with no two near each other.
  gather(0);
  if (count <= kFloatLanes) {
    if (anyWithin(block(0)) == 0) return false;
  } else if (count == kFloatLanes + 1) {  // three by three
    const std::int32_t last = bucketMembers[kFloatLanes];
    for (int axis = 0; axis < 3; ++axis) {
      x[axis][kFloatLanes] = static_cast<float>(a.x[axis][last] - a.x[axis][bucketMembers[0]]);
    }
    const FloatPack3 points = block(0);
    if ((anyWithin(points) | Within(points, alone(kFloatLanes), squared)) == 0) return false;
    gather(kFloatLanes);
  } else {
    for (int m = kFloatLanes; m < count; m += kFloatLanes) gather(m);
  }
  members = bucketMembers;
  todo = 0;
  for (int m = 0; m < count; ++m) {
    const FloatPack3 point = alone(m);
    std::uint64_t bits = 0;
    for (int other = 0; other < count; other += kFloatLanes) {
      bits |= std::uint64_t{Within(block(other), point, squared)} << other;
    }
    near[m] = bits & ~(std::uint64_t{1} << m);
    todo |= std::uint64_t{near[m] != 0} << m;
  }
  return todo != 0;
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
  std::int32_t others[NearPoints::kMost][kLanes];

  PushLanes() {
    for (NearPoints& bucket : buckets) bucket.todo = 0;
  }

  /// Moves the next point of every bucket that has one left. Returns how many pushes that took.
  std::int64_t Turn(const BucketArgs& a);
  std::int64_t TurnOneByOne(const BucketArgs& a, const std::int32_t points[kLanes], const int count[kLanes]);
};

/// The same for points of which some coincide.
inline std::int64_t PushLanes::TurnOneByOne(const BucketArgs& a, const std::int32_t points[kLanes],
                                            const int count[kLanes]) {
  std::int64_t contacts = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    std::int32_t near[NearPoints::kMost];
    for (int k = 0; k < count[lane]; ++k) near[k] = others[k][lane];
    if (count[lane] > 0) contacts += PushApart(a, points[lane], near, count[lane]);
  }
  return contacts;
}

inline std::int64_t PushLanes::Turn(const BucketArgs& a) {
  constexpr int kOften = 2;  // most points have no more others near them
  std::int32_t points[kLanes];
  int count[kLanes], most = kOften;
  double counts[kLanes];
  // Lanes that have none left take a point that no other thread has: the first lane was filled first.
  const std::int32_t idle = buckets[0].members[0];
  for (int lane = 0; lane < kLanes; ++lane) {
    NearPoints& bucket = buckets[lane];
    std::uint64_t bits = 0;
    points[lane] = idle;
    if (bucket.todo != 0) {
      const int m = LowestBit(bucket.todo);
      bucket.todo &= bucket.todo - 1;
      bits = bucket.near[m];
      points[lane] = bucket.members[m];
    }
    count[lane] = BitCount(bits);
    counts[lane] = count[lane];
    for (int k = 0; k < kOften; ++k) {
      others[k][lane] = bits != 0 ? bucket.members[LowestBit(bits)] : points[lane];
      bits &= bits - 1;
    }
    for (int k = kOften; bits != 0; ++k, bits &= bits - 1) others[k][lane] = bucket.members[LowestBit(bits)];
    most = count[lane] > most ? count[lane] : most;
  }
  for (int lane = 0; lane < kLanes && most > kOften; ++lane) {
    for (int k = count[lane] > kOften ? count[lane] : kOften; k < most; ++k) others[k][lane] = points[lane];
  }

  const Pack3 x = Gather3(a.x, points);
  const Pack near = Load(counts);
  Pack3 sum = Zero3();
  Pack pushes = All(0);
  for (int k = 0; k < most; ++k) {
    const Mask valid = near > All(k);
    const Pack3 d = x - Gather3(a.x, others[k]);
    const Pack distance = Sqrt(SquaredLength(d));
    const Pack apart =
        a.sameThickness ? All(a.greatestApart) : Gather(a.thickness, points) + Gather(a.thickness, others[k]);
    const Mask push = valid & (distance <= apart);
    if (Bits(push & (distance <= All(0))) != 0) return TurnOneByOne(a, points, count);
    sum = sum + d * Where(push, (apart - distance) / distance);
    pushes = pushes + Where(push, All(1));
  }
  const Mask moves = pushes > All(0);
  const Pack share = pushes * All(a.stepsPerFrame);
  double to[3][kLanes], number[kLanes];
  Store(to[0], x.x + sum.x / share), Store(to[1], x.y + sum.y / share), Store(to[2], x.z + sum.z / share);
  Store(number, pushes);
  std::int64_t contacts = 0;
  for (unsigned bits = Bits(moves); bits != 0; bits &= bits - 1) {
    const int lane = LowestBit(bits);
    contacts += static_cast<std::int64_t>(number[lane]);
    if (a.fixed[points[lane]]) continue;
    for (int axis = 0; axis < 3; ++axis) a.x[axis][points[lane]] = to[axis][lane];
  }
  return contacts;
}

constexpr double kMostSpan = 1e9;  // m; far below the numbers that GatherFloats puts into empty lanes

std::int64_t SeparateBuckets(const BucketArgs& a) {
  // No point moves farther than a part in stepsPerFrame of the distance that it keeps: farther pairs
  // than that stay apart. Coordinates in float are off by 2^-24 of the span: rather look twice.
  const double farthest = a.greatestApart * (1 + 1 / a.stepsPerFrame);
  const double floatFarthest = farthest * (1 + 1e-5) + 1e-6 * a.greatestSpan;
  const float nearSquared = static_cast<float>(floatFarthest * floatFarthest) + 1e-30f;  // whatever underflows
  const int mostNear = a.greatestSpan < kMostSpan ? NearPoints::kMost : 0;
  std::int64_t contacts = 0;
  PushLanes lanes;
  int bucket = a.bucketBegin;
  const auto fill = [&](NearPoints& lane) {  // with the next bucket that has near points
    while (bucket < a.bucketEnd) {
      const std::int32_t* members = a.members + a.first[bucket];
      const int count = a.count[bucket++];
      if (count < 2) continue;
      if (count > mostNear) {
        contacts += SeparateMany(a, members, count, farthest);
      } else if (lane.Find(a, members, count, nearSquared)) {
        return true;
      }
    }
    return false;
  };
  for (bool any = true; any;) {
    any = false;
    for (NearPoints& lane : lanes.buckets) any |= lane.todo != 0 || fill(lane);
    if (any) contacts += lanes.Turn(a);
  }
  return contacts;
}
