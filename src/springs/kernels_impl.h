// The kernels of kernels.h. Included by one source file per instruction set, which names the
// namespace PERCALE_KERNELS first. No header with inline functions that other files compile too may
// be included here: the linker would be free to keep the copy that not every processor runs.

#include <math.h>
#include <string.h>

#include "springs/kernels.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif
#if defined(_MSC_VER)
#include <intrin.h>
#endif

namespace percale::springs::PERCALE_KERNELS {
namespace {

#if defined(_MSC_VER)
#define PERCALE_RESTRICT __restrict
#define PERCALE_INLINE __forceinline
inline double Sqrt(double v) {
  return ::sqrt(v);
}
inline int LowestBit(std::uint64_t bits) {
  unsigned long index;
  _BitScanForward64(&index, bits);
  return static_cast<int>(index);
}
#else
#define PERCALE_RESTRICT __restrict__
#define PERCALE_INLINE __attribute__((always_inline)) inline
inline double Sqrt(double v) {
  return __builtin_sqrt(v);
}
inline int LowestBit(std::uint64_t bits) {
  return __builtin_ctzll(bits);
}
#endif

using Array = const double* PERCALE_RESTRICT;
using OutArray = double* PERCALE_RESTRICT;

#include "springs/pack4.h"

/// Kinds in creation order, as in mesh/cloth_model.h.
enum { kLeft, kUp, kUpperLeft, kUpperRight, kTwoLeft, kTwoUp, kKinds };
constexpr int kDi[kKinds] = {-1, 0, -1, 1, -2, 0};
constexpr int kDj[kKinds] = {0, -1, -1, -1, 0, -2};

constexpr int kPad = kGridPad;  // zeros on both sides of a row of spring forces
constexpr double kNoSpring = kNoSpringRest;

/// A point feels the springs of its own row, the next and the one after. So the rows are walked
/// once: the springs of row j complete the forces of row j - 2, which then moves. Forces read
/// positions only, and the new ones go where the previous ones were. Each point sums its forces in
/// creation order: its own springs, then those created by its right neighbours, by the row below,
/// and by the row after that.
class Integrator {
 public:
  PERCALE_INLINE explicit Integrator(const IntegrateArgs& args) : args_(args), n_(args.numWidth) {
    double* free = args_.scratch + kPad;
    for (auto& kind : spring_) {
      for (double*& axis : kind) axis = free, free += RowStride(n_);
    }
    for (auto& of : force_) {
      for (double*& axis : of) axis = free, free += RowStride(n_);
    }
    for (int kind = 0; kind < kKinds; ++kind) {
      step_[kind] = static_cast<std::int64_t>(kDj[kind]) * n_ + kDi[kind];
      stiffness_[kind] = All(args_.stiffness[kind]);
    }
  }

  PERCALE_INLINE std::int64_t Run() {
    const int last = args_.rowEnd + 2 < args_.numHeight ? args_.rowEnd + 2 : args_.numHeight;
    for (int j = args_.rowBegin; j < last; ++j) {
      PrepareRow(j);
      // Springs are bound by division, sums by memory: done side by side they overlap. The sums lag
      // behind, since they need the springs of the columns to the right, and so far behind that
      // what they load has left the store buffer.
      for (int i = 0; i < n_; i += kLanes) {
        if (activeCount_ == kKinds) {
          for (int kind = 0; kind < kKinds; ++kind) SpringBlock(kind, i);
        } else {
          for (int k = 0; k < activeCount_; ++k) SpringBlock(active_[k], i);
        }
        if (i >= kLag) SumBlock(j, i - kLag);
      }
      for (int k = 0; k < activeCount_; ++k) {
        for (double* axis : spring_[active_[k]]) axis[n_] = axis[n_ + 1] = 0;  // the last block wrote beyond the row
      }
      const int end = (n_ + kLanes - 1) / kLanes * kLanes;
      for (int i = end > kLag ? end - kLag : 0; i < n_; i += kLanes) SumBlock(j, i);
    }
    // The last rows of the sheet have none below them that would complete their forces.
    withTwoUp_ = false;
    for (int j = last - 2 > args_.rowBegin ? last - 2 : args_.rowBegin; j < args_.rowEnd; ++j) {
      moving_ = j;
      for (int i = 0; i < n_; i += kLanes) MoveBlock(i);
    }
    return outOfBounds_;
  }

 private:
  static constexpr int kLag = 4 * kLanes;

  /// Decides which kinds of springs row j creates that matter, and which rows they complete.
  PERCALE_INLINE void PrepareRow(int j) {
    row_ = static_cast<std::int64_t>(j) * n_;
    activeCount_ = 0;
    for (int kind = 0; kind < kKinds; ++kind) {
      const int other = j + kDj[kind];
      if (other >= args_.rowEnd) continue;  // both ends beyond the rows that move
      if (other >= 0 && args_.stiffness[kind] != 0) {
        active_[activeCount_++] = kind;
        continue;
      }
      for (double* axis : spring_[kind]) {
        for (int i = 0; i < n_; ++i) axis[i] = 0;
      }
    }
    sumOwn_ = j < args_.rowEnd;
    sumNext_ = j - 1 >= args_.rowBegin && j - 1 < args_.rowEnd;
    withTwoUp_ = j - 2 >= args_.rowBegin;
    moving_ = j - 2;
  }

  /// Forces on the creators of four springs.
  PERCALE_INLINE void SpringBlock(int kind, int i) {
    const std::int64_t at = row_ + i;
    const Pack3 d = Load3(args_.x, at + step_[kind]) - Load3(args_.x, at);
    const Pack length = Sqrt(SquaredLength(d));
    const Pack rest = Load(args_.rest[kind] + at);
    // Ends that coincide have no direction, and at the borders there is no spring.
    const Mask pulls = (length > All(0)) & (All(kNoSpring) > rest);
    const Pack factor = Where(pulls, stiffness_[kind] * (length - rest) / length);
    Store(spring_[kind][0] + i, d.x * factor);
    Store(spring_[kind][1] + i, d.y * factor);
    Store(spring_[kind][2] + i, d.z * factor);
  }

  PERCALE_INLINE void SumBlock(int j, int i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto of = [&](int kind, int column) { return Load(spring_[kind][axis] + column); };
      if (sumOwn_) {
        Pack sum = All(args_.weight[axis]);
        if (args_.extraForce[axis]) sum = sum + Load(args_.extraForce[axis] + row_ + i);
        sum = sum + of(kLeft, i) + of(kUp, i) + of(kUpperLeft, i) + of(kUpperRight, i) + of(kTwoLeft, i) +
              of(kTwoUp, i) - of(kLeft, i + 1) - of(kTwoLeft, i + 2);
        Store(force_[j % 3][axis] + i, sum);
      }
      if (sumNext_) {
        double* sum = force_[(j + 2) % 3][axis] + i;
        Store(sum, Load(sum) - of(kUpperRight, i - 1) - of(kUp, i) - of(kUpperLeft, i + 1));
      }
    }
    if (withTwoUp_) MoveBlock(i);
  }

  /// Verlet for four points of the row that moves.
  PERCALE_INLINE void MoveBlock(int i) {
    const std::int64_t at = static_cast<std::int64_t>(moving_) * n_ + i;
    for (int axis = 0; axis < 3; ++axis) {
      double* previous = args_.previous[axis] + at;
      if (i + kLanes <= n_) {
        const Pack next = Moved(axis, i, at, Load(previous));
        Store(previous, next);
        outOfBounds_ += InBounds(next) != 15u;
      } else {
        // What lies beyond the row may be another thread's, which is writing it: not even to be read.
        const int count = n_ - i;
        const Pack next = Moved(axis, i, at, LoadFirst(previous, count));
        StoreFirst(previous, next, count);
        outOfBounds_ += (InBounds(next) | (15u << count & 15u)) != 15u;
      }
    }
  }
  /// Where four points go that were at `before` one step ago.
  PERCALE_INLINE Pack Moved(int axis, int i, std::int64_t at, Pack before) const {
    Pack sum = Load(force_[moving_ % 3][axis] + i);
    if (withTwoUp_) sum = sum - Load(spring_[kTwoUp][axis] + i);
    const Pack x = Load(args_.x[axis] + at);
    return x + All(args_.keep) * (x - before) + All(args_.forceToWay) * sum;
  }
  /// A bit for each of four coordinates that is within bounds.
  PERCALE_INLINE unsigned InBounds(Pack next) const {
    return Bits((next <= All(args_.bound)) & (All(-args_.bound) <= next));
  }

  const IntegrateArgs args_;
  const int n_;
  double* spring_[kKinds][3];  // forces on the creators of one row
  double* force_[3][3];        // of rows j, j - 1, j - 2, in turn
  std::int64_t step_[kKinds];
  Pack stiffness_[kKinds];
  std::int64_t row_ = 0;
  int active_[kKinds] = {}, activeCount_ = 0;
  bool sumOwn_ = false, sumNext_ = false, withTwoUp_ = false;
  int moving_ = 0;
  std::int64_t outOfBounds_ = 0;
};

std::int64_t Integrate(const IntegrateArgs& args) {
  return Integrator(args).Run();
}

std::int64_t MarkLongSprings(const LongSpringsArgs& a) {
  const std::int64_t begin = static_cast<std::int64_t>(a.rowBegin) * a.numWidth;
  const std::int64_t end = static_cast<std::int64_t>(a.rowEnd) * a.numWidth;
  const Pack limit = All(a.limit * (1 - 1e-12));  // squares round: rather mark one too many
  std::int64_t step[kKinds];
  for (int kind = 0; kind < kKinds; ++kind) step[kind] = static_cast<std::int64_t>(kDj[kind]) * a.numWidth + kDi[kind];
  for (std::int64_t p = begin; p < end; ++p) a.longKinds[p] = 0;
  std::int64_t total = 0;
  for (std::int64_t p = begin; p < end; p += kLanes) {
    // The last block overlaps the one before it: marking twice does no harm.
    const std::int64_t at = p + kLanes <= end ? p : end - kLanes;
    const Pack3 x = Load3(a.x, at);
    Mask longer[kKinds];
    for (int kind = 0; kind < kKinds; ++kind) {
      const Pack longest = limit * Load(a.rest[kind] + at);
      longer[kind] = SquaredLength(Load3(a.x, at + step[kind]) - x) > longest * longest;
    }
    if (Bits(longer[0] | longer[1] | longer[2] | longer[3] | longer[4] | longer[5]) == 0) continue;
    for (int kind = 0; kind < kKinds; ++kind) {
      for (unsigned bits = Bits(longer[kind]); bits != 0; bits &= bits - 1) {
        a.longKinds[at + LowestBit(bits)] |= static_cast<std::uint8_t>(1u << kind);
        ++total;
      }
    }
  }
  return total;
}

/// Adding this to a number of at most 2^51 rounds it to a whole one, which then stands in the low bits.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52
constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << 21) - 1;

inline std::uint64_t FloorBits(double v) {
  const double rounded = v + kRounder;
  const double whole = rounded - kRounder;
  const double floored = rounded - (whole > v ? 1.0 : 0.0);
  std::uint64_t bits;
  memcpy(&bits, &floored, sizeof bits);
  return bits & kIndexMask;
}

void BoxKeys(const BoxKeyArgs& a) {
  Array x = a.x[0], y = a.x[1], z = a.x[2];
  std::uint64_t* PERCALE_RESTRICT key = a.key;
  const double w = a.boxSize[0], h = a.boxSize[1], t = a.boxSize[2];
  for (int p = 0; p < a.count; ++p) {
    key[p] = FloorBits(x[p] / w) | FloorBits(y[p] / h) << 21 | FloorBits(z[p] / t) << 42;
  }
}

/// Which of the points from `at` on lie within a squared distance of p: a bit each.
inline unsigned Within(const double* const x[3], int at, const Pack3& p, Pack squared) {
  return Bits(SquaredLength(p - Load3(x, at)) <= squared);
}

/// The points of one bucket, in arrays of their own. Beyond them stand points that are near nothing.
struct BucketPoints {
  double* x[3];
  int count;
};

constexpr int kMostMasked = 64;

/// For each point of a bucket of at most 64, a bit for every other that may come too close to it
/// while the bucket's points move. Returns whether there is any.
bool FindNear(const BucketPoints& b, Pack squared, std::uint64_t near[kMostMasked]) {
  for (int m = 0; m < b.count; ++m) near[m] = 0;
  bool any = false;
  for (int m = 0; m + 1 < b.count; ++m) {
    const Pack3 p = {All(b.x[0][m]), All(b.x[1][m]), All(b.x[2][m])};
    for (int other = m + 1; other < b.count; other += kLanes) {
      std::uint64_t bits = Within(b.x, other, p, squared);
      if (bits == 0) continue;
      any = true;
      near[m] |= bits << other;
      for (; bits != 0; bits &= bits - 1) near[other + LowestBit(bits)] |= std::uint64_t{1} << m;
    }
  }
  return any;
}

/// The sum of pushes on one point.
struct Push {
  double x = 0, y = 0, z = 0;
  int count = 0;

  /// Adds the push of a point at distance vector d, if it is nearer than `apart`.
  void Add(double dx, double dy, double dz, double apart) {
    const double squared = dx * dx + dy * dy + dz * dz;
    if (squared > apart * apart * (1 + 1e-12)) return;
    const double distance = Sqrt(squared);
    if (distance > apart) return;
    const double push = apart - distance;
    if (distance > 0) {
      x += dx / distance * push;
      y += dy / distance * push;
      z += dz / distance * push;
    } else {
      y += push;  // points that coincide part along +y
    }
    ++count;
  }
};

std::int64_t SeparateBucket(const BucketArgs& a, const std::int32_t* members, const BucketPoints& b, Pack nearSquared) {
  std::uint64_t near[kMostMasked];
  const bool masked = b.count <= kMostMasked;
  if (masked && !FindNear(b, nearSquared, near)) return 0;
  std::int64_t contacts = 0;
  for (int m = 0; m < b.count; ++m) {
    if (masked && near[m] == 0) continue;
    const double px = b.x[0][m], py = b.x[1][m], pz = b.x[2][m], thickness = a.thickness[members[m]];
    Push push;
    const auto add = [&](int other) {
      push.Add(px - b.x[0][other], py - b.x[1][other], pz - b.x[2][other], thickness + a.thickness[members[other]]);
    };
    if (masked) {
      for (std::uint64_t bits = near[m]; bits != 0; bits &= bits - 1) add(LowestBit(bits));
    } else {
      const Pack3 p = {All(px), All(py), All(pz)};
      for (int base = 0; base < b.count; base += kLanes) {
        for (unsigned bits = Within(b.x, base, p, nearSquared); bits != 0; bits &= bits - 1) {
          const int other = base + LowestBit(bits);
          if (other != m) add(other);
        }
      }
    }
    contacts += push.count;
    if (push.count == 0 || a.fixed[members[m]]) continue;
    const double way[3] = {push.x / push.count / a.stepsPerFrame, push.y / push.count / a.stepsPerFrame,
                           push.z / push.count / a.stepsPerFrame};
    for (int axis = 0; axis < 3; ++axis) a.x[axis][members[m]] = b.x[axis][m] += way[axis];
  }
  return contacts;
}

std::int64_t SeparateBuckets(const BucketArgs& a) {
  // No point moves farther than a part in stepsPerFrame of the distance that it keeps: farther pairs
  // than that stay apart. Squares round: rather look twice.
  const double farthest = a.greatestApart * (1 + 1 / a.stepsPerFrame);
  const Pack nearSquared = All(farthest * farthest * (1 + 1e-12));
  std::int64_t contacts = 0;
  for (int bucket = a.bucketBegin; bucket < a.bucketEnd; ++bucket) {
    const std::int32_t* members = a.members + a.first[bucket];
    BucketPoints b;
    b.count = a.first[bucket + 1] - a.first[bucket];
    if (b.count < 2) continue;
    const int room = b.count + kLanes;
    for (int axis = 0; axis < 3; ++axis) {
      double* PERCALE_RESTRICT to = b.x[axis] = a.scratch + axis * room;
      const double* from = a.x[axis];
      for (int m = 0; m < b.count; ++m) to[m] = from[members[m]];
      Store(to + b.count, All(1e300));  // its square is infinite
    }
    contacts += SeparateBucket(a, members, b, nearSquared);
  }
  return contacts;
}

/// Colliders touch few points: a block is searched before any of it is computed.
constexpr int kBlock = 64;

std::int64_t CollideSphere(const ColliderArgs& a) {
  OutArray x = a.x[0];
  OutArray y = a.x[1];
  OutArray z = a.x[2];
  Array qx = a.previous[0], qy = a.previous[1], qz = a.previous[2];
  const double ox = a.origin[0], oy = a.origin[1], oz = a.origin[2];
  const double r = a.radius, keep = 1 - a.friction;
  const double squared = r * r * (1 + 1e-12);  // rather look twice
  std::int64_t total = 0;
  for (int begin = a.begin; begin < a.end; begin += kBlock) {
    const int end = begin + kBlock < a.end ? begin + kBlock : a.end;
    std::int64_t near = 0;
    for (int p = begin; p < end; ++p) {
      const double dx = x[p] - ox, dy = y[p] - oy, dz = z[p] - oz;
      near += dx * dx + dy * dy + dz * dz <= squared ? 1 : 0;
    }
    if (near == 0) continue;
    for (int p = begin; p < end; ++p) {
      const double dx = x[p] - ox, dy = y[p] - oy, dz = z[p] - oz;
      const double length = Sqrt(dx * dx + dy * dy + dz * dz);
      const bool inside = length <= r;
      const double ux = length > 0 ? dx / length : 0;
      const double uy = length > 0 ? dy / length : 1;
      const double uz = length > 0 ? dz / length : 0;
      const double nx = qx[p] + keep * (ox + r * ux - qx[p]);
      const double ny = qy[p] + keep * (oy + r * uy - qy[p]);
      const double nz = qz[p] + keep * (oz + r * uz - qz[p]);
      x[p] = inside ? nx : x[p];
      y[p] = inside ? ny : y[p];
      z[p] = inside ? nz : z[p];
      total += inside ? 1 : 0;
    }
  }
  return total;
}

constexpr double kPlaneOffset = 1e-4;  // m above the plane, on the side that a point came from
enum { kInterpolate, kOffset, kHold };

template <int response>
std::int64_t CollidePlaneBy(const ColliderArgs& a) {
  OutArray x = a.x[0];
  OutArray y = a.x[1];
  OutArray z = a.x[2];
  Array qx = a.previous[0], qy = a.previous[1], qz = a.previous[2];
  const double ox = a.origin[0], oy = a.origin[1], oz = a.origin[2];
  const double nx = a.normal[0], ny = a.normal[1], nz = a.normal[2];
  const double keep = 1 - a.friction;
  std::int64_t total = 0;
  for (int begin = a.begin; begin < a.end; begin += kBlock) {
    const int end = begin + kBlock < a.end ? begin + kBlock : a.end;
    std::int64_t crossing = 0;
    for (int p = begin; p < end; ++p) {
      const double before = (qx[p] - ox) * nx + (qy[p] - oy) * ny + (qz[p] - oz) * nz;
      const double after = (x[p] - ox) * nx + (y[p] - oy) * ny + (z[p] - oz) * nz;
      crossing += (before >= 0 ? 1 : 0) != (after >= 0 ? 1 : 0) ? 1 : 0;
    }
    if (crossing == 0) continue;
    total += crossing;
    for (int p = begin; p < end; ++p) {
      const double before = (qx[p] - ox) * nx + (qy[p] - oy) * ny + (qz[p] - oz) * nz;
      const double after = (x[p] - ox) * nx + (y[p] - oy) * ny + (z[p] - oz) * nz;
      const bool crossed = (before >= 0) != (after >= 0);
      double rx = qx[p], ry = qy[p], rz = qz[p];  // where it is put: with kHold, back
      if constexpr (response != kHold) {
        const double offset = (before >= 0 ? 1.0 : -1.0) * kPlaneOffset;
        double tx, ty, tz;
        if constexpr (response == kInterpolate) {
          const double way = before / (before - after);
          tx = qx[p] + way * (x[p] - qx[p]);
          ty = qy[p] + way * (y[p] - qy[p]);
          tz = qz[p] + way * (z[p] - qz[p]);
        } else {
          tx = x[p] - after * nx;
          ty = y[p] - after * ny;
          tz = z[p] - after * nz;
        }
        rx = qx[p] + keep * (tx + offset * nx - qx[p]);
        ry = qy[p] + keep * (ty + offset * ny - qy[p]);
        rz = qz[p] + keep * (tz + offset * nz - qz[p]);
      }
      x[p] = crossed ? rx : x[p];
      y[p] = crossed ? ry : y[p];
      z[p] = crossed ? rz : z[p];
    }
  }
  return total;
}

std::int64_t CollidePlane(const ColliderArgs& a) {
  switch (a.response) {
    case kInterpolate:
      return CollidePlaneBy<kInterpolate>(a);
    case kOffset:
      return CollidePlaneBy<kOffset>(a);
    default:
      return CollidePlaneBy<kHold>(a);
  }
}

}  // namespace

extern const Kernels kKernels = {PERCALE_KERNELS_NAME, Integrate,     MarkLongSprings, BoxKeys,
                                 SeparateBuckets,      CollideSphere, CollidePlane};

}  // namespace percale::springs::PERCALE_KERNELS
