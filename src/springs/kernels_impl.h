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

constexpr int kPad = kRowPad;  // zeros on both sides of a row of spring forces

inline int FirstColumn(int kind) {
  return kDi[kind] < 0 ? -kDi[kind] : 0;
}
inline int EndColumn(int kind, int numWidth) {
  return kDi[kind] > 0 ? numWidth - kDi[kind] : numWidth;
}

/// Force on the creators a of one row of springs, whose other ends are b.
void SpringRow(int begin, int end, Array ax, Array ay, Array az, Array bx, Array by, Array bz, Array rest,
               double stiffness, OutArray fx, OutArray fy, OutArray fz) {
  for (int i = begin; i < end; ++i) {
    const double dx = bx[i] - ax[i];
    const double dy = by[i] - ay[i];
    const double dz = bz[i] - az[i];
    const double length = Sqrt(dx * dx + dy * dy + dz * dz);
    const double ratio = stiffness * (length - rest[i]) / length;
    const double factor = length > 0 ? ratio : 0;  // ends that coincide have no direction
    fx[i] = dx * factor;
    fy[i] = dy * factor;
    fz[i] = dz * factor;
  }
}

/// Adds the forces of the springs within a row, in creation order: a point's own, then those that
/// its right neighbours created.
void AddOwnForces(int n, double weight, Array extra, Array left, Array up, Array upperLeft, Array upperRight,
                  Array twoLeft, Array twoUp, OutArray force) {
  if (extra) {
    for (int i = 0; i < n; ++i) {
      force[i] = weight + extra[i] + left[i] + up[i] + upperLeft[i] + upperRight[i] + twoLeft[i] + twoUp[i] -
                 left[i + 1] - twoLeft[i + 2];
    }
    return;
  }
  for (int i = 0; i < n; ++i) {
    force[i] =
        weight + left[i] + up[i] + upperLeft[i] + upperRight[i] + twoLeft[i] + twoUp[i] - left[i + 1] - twoLeft[i + 2];
  }
}

/// The same for the springs that the row below created.
void AddForcesOfNextRow(int n, Array up, Array upperLeft, Array upperRight, OutArray force) {
  for (int i = 0; i < n; ++i) force[i] = force[i] - upperRight[i - 1] - up[i] - upperLeft[i + 1];
}

/// Verlet; `twoUp`, if any, are the forces of the springs from two rows below.
std::int64_t VerletRow(int n, Array x, OutArray previous, Array force, const double* twoUp, double keep,
                       double forceToWay, double bound) {
  std::int64_t outOfBounds = 0;
  if (twoUp) {
    Array last = twoUp;
    for (int i = 0; i < n; ++i) {
      const double next = x[i] + keep * (x[i] - previous[i]) + forceToWay * (force[i] - last[i]);
      outOfBounds += ((next <= bound) & (next >= -bound)) ? 0 : 1;
      previous[i] = next;
    }
    return outOfBounds;
  }
  for (int i = 0; i < n; ++i) {
    const double next = x[i] + keep * (x[i] - previous[i]) + forceToWay * force[i];
    outOfBounds += ((next <= bound) & (next >= -bound)) ? 0 : 1;
    previous[i] = next;
  }
  return outOfBounds;
}

/// A point feels the springs of its own row, the next and the one after. So the rows are walked
/// once: the springs of row j complete the forces of row j - 2, which then moves. Forces read
/// positions only, and the new ones go where the previous ones were.
std::int64_t Integrate(const IntegrateArgs& a) {
  const int n = a.numWidth;
  const int stride = RowStride(n);
  double* springForce[kKinds][3];
  double* force[3][3];  // of rows j, j - 1, j - 2, in turn
  double* free = a.scratch + kPad;
  for (auto& kind : springForce) {
    for (double*& axis : kind) axis = free, free += stride;
  }
  for (auto& row : force) {
    for (double*& axis : row) axis = free, free += stride;
  }

  std::int64_t outOfBounds = 0;
  const auto move = [&](int row, bool withTwoUp) {
    const std::int64_t at = static_cast<std::int64_t>(row) * n;
    for (int axis = 0; axis < 3; ++axis) {
      outOfBounds += VerletRow(n, a.x[axis] + at, a.previous[axis] + at, force[row % 3][axis],
                               withTwoUp ? springForce[kTwoUp][axis] : nullptr, a.keep, a.forceToWay, a.bound);
    }
  };

  const int last = a.rowEnd + 2 < a.numHeight ? a.rowEnd + 2 : a.numHeight;
  for (int j = a.rowBegin; j < last; ++j) {
    const std::int64_t at = static_cast<std::int64_t>(j) * n;
    for (int kind = 0; kind < kKinds; ++kind) {
      const int begin = FirstColumn(kind), end = EndColumn(kind, n);
      const bool exists = j + kDj[kind] >= 0;
      // Beyond the last row that moves, only springs that reach back to it matter.
      if (exists && j + kDj[kind] >= a.rowEnd) continue;
      if (!exists || a.stiffness[kind] == 0) {
        for (int axis = 0; axis < 3; ++axis) {
          for (int i = begin; i < end; ++i) springForce[kind][axis][i] = 0;
        }
        continue;
      }
      const std::int64_t other = at + static_cast<std::int64_t>(kDj[kind]) * n + kDi[kind];
      SpringRow(begin, end, a.x[0] + at, a.x[1] + at, a.x[2] + at, a.x[0] + other, a.x[1] + other, a.x[2] + other,
                a.rest[kind] + at, a.stiffness[kind], springForce[kind][0], springForce[kind][1], springForce[kind][2]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (j < a.rowEnd) {
        AddOwnForces(n, a.weight[axis], a.extraForce[axis] ? a.extraForce[axis] + at : nullptr,
                     springForce[kLeft][axis], springForce[kUp][axis], springForce[kUpperLeft][axis],
                     springForce[kUpperRight][axis], springForce[kTwoLeft][axis], springForce[kTwoUp][axis],
                     force[j % 3][axis]);
      }
      if (j - 1 >= a.rowBegin && j - 1 < a.rowEnd) {
        AddForcesOfNextRow(n, springForce[kUp][axis], springForce[kUpperLeft][axis], springForce[kUpperRight][axis],
                           force[(j - 1) % 3][axis]);
      }
    }
    if (j - 2 >= a.rowBegin) move(j - 2, true);
  }
  // The last rows of the sheet have none below them that would complete their forces.
  for (int j = last - 2 > a.rowBegin ? last - 2 : a.rowBegin; j < a.rowEnd; ++j) move(j, false);
  return outOfBounds;
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
    const Pack3 x = Load3(a.x, p);
    Mask longer[kKinds];
    for (int kind = 0; kind < kKinds; ++kind) {
      const Pack longest = limit * Load(a.rest[kind] + p);
      longer[kind] = SquaredLength(Load3(a.x, p + step[kind]) - x) > longest * longest;
    }
    if (Bits(longer[0] | longer[1] | longer[2] | longer[3] | longer[4] | longer[5]) == 0) continue;
    // Lanes beyond the last row belong to others.
    const unsigned own = end - p < kLanes ? (1u << (end - p)) - 1 : ~0u;
    for (int kind = 0; kind < kKinds; ++kind) {
      for (unsigned bits = Bits(longer[kind]) & own; bits != 0; bits &= bits - 1) {
        a.longKinds[p + LowestBit(bits)] |= static_cast<std::uint8_t>(1u << kind);
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
