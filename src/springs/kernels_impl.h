// The kernels of kernels.h. Included by one source file per instruction set, which names the
// namespace PERCALE_KERNELS first. No header with inline functions that other files compile too may
// be included here: the linker would be free to keep the copy that not every processor runs.

#include "springs/kernels.h"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace percale::springs::PERCALE_KERNELS {
namespace {

#if defined(_MSC_VER)
#define PERCALE_RESTRICT __restrict
#include <math.h>
inline double Sqrt(double v) { return ::sqrt(v); }
#else
#define PERCALE_RESTRICT __restrict__
inline double Sqrt(double v) { return __builtin_sqrt(v); }
#endif

using Array = const double* PERCALE_RESTRICT;
using OutArray = double* PERCALE_RESTRICT;

/// Kinds in creation order, as in mesh/cloth_model.h.
enum { kLeft, kUp, kUpperLeft, kUpperRight, kTwoLeft, kTwoUp, kKinds };
constexpr int kDi[kKinds] = {-1, 0, -1, 1, -2, 0};
constexpr int kDj[kKinds] = {0, -1, -1, -1, 0, -2};

constexpr int kPad = 2;  // zeros on both sides of a row of spring forces

inline int FirstColumn(int kind) { return kDi[kind] < 0 ? -kDi[kind] : 0; }
inline int EndColumn(int kind, int numWidth) { return kDi[kind] > 0 ? numWidth - kDi[kind] : numWidth; }

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
    force[i] = weight + left[i] + up[i] + upperLeft[i] + upperRight[i] + twoLeft[i] + twoUp[i] - left[i + 1] -
               twoLeft[i + 2];
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
  const int stride = n + 2 * kPad;
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
                a.rest[kind] + at, a.stiffness[kind], springForce[kind][0], springForce[kind][1],
                springForce[kind][2]);
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

std::int64_t CountLong(int begin, int end, Array ax, Array ay, Array az, Array bx, Array by, Array bz, Array rest,
                       double limit) {
  std::int64_t count = 0;
  for (int i = begin; i < end; ++i) {
    const double dx = bx[i] - ax[i];
    const double dy = by[i] - ay[i];
    const double dz = bz[i] - az[i];
    const double longest = limit * rest[i];
    count += dx * dx + dy * dy + dz * dz > longest * longest ? 1 : 0;
  }
  return count;
}

std::int64_t MarkLongSprings(const LongSpringsArgs& a) {
  const int n = a.numWidth;
  const double limit = a.limit * (1 - 1e-12);  // squares round: rather mark one too many
  std::int64_t total = 0;
  for (int j = a.rowBegin; j < a.rowEnd; ++j) {
    const std::int64_t at = static_cast<std::int64_t>(j) * n;
    std::uint8_t* marks = a.longKinds + at;
    for (int i = 0; i < n; ++i) marks[i] = 0;
    for (int kind = 0; kind < kKinds; ++kind) {
      if (j + kDj[kind] < 0) continue;
      const int begin = FirstColumn(kind), end = EndColumn(kind, n);
      const std::int64_t other = at + static_cast<std::int64_t>(kDj[kind]) * n + kDi[kind];
      const double* rest = a.rest[kind] + at;
      const std::int64_t count = CountLong(begin, end, a.x[0] + at, a.x[1] + at, a.x[2] + at, a.x[0] + other,
                                           a.x[1] + other, a.x[2] + other, rest, limit);
      if (count == 0) continue;
      total += count;
      for (int i = begin; i < end; ++i) {
        double squared = 0;
        for (const double* axis : a.x) squared += (axis[other + i] - axis[at + i]) * (axis[other + i] - axis[at + i]);
        const double longest = limit * rest[i];
        marks[i] = static_cast<std::uint8_t>(marks[i] | (squared > longest * longest ? 1 << kind : 0));
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
  __builtin_memcpy(&bits, &floored, sizeof bits);
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

constexpr int kLanes = 8;

/// Which of eight points lie within a squared distance: a bit each.
inline unsigned Within(Array x, Array y, Array z, double px, double py, double pz, double squared) {
#if defined(__AVX512F__)
  const __m512d dx = _mm512_sub_pd(_mm512_set1_pd(px), _mm512_loadu_pd(x));
  const __m512d dy = _mm512_sub_pd(_mm512_set1_pd(py), _mm512_loadu_pd(y));
  const __m512d dz = _mm512_sub_pd(_mm512_set1_pd(pz), _mm512_loadu_pd(z));
  const __m512d sum =
      _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy)), _mm512_mul_pd(dz, dz));
  return _mm512_cmp_pd_mask(sum, _mm512_set1_pd(squared), _CMP_LE_OQ);
#elif defined(__AVX2__)
  unsigned bits = 0;
  for (int half = 0; half < 2; ++half) {
    const __m256d dx = _mm256_sub_pd(_mm256_set1_pd(px), _mm256_loadu_pd(x + 4 * half));
    const __m256d dy = _mm256_sub_pd(_mm256_set1_pd(py), _mm256_loadu_pd(y + 4 * half));
    const __m256d dz = _mm256_sub_pd(_mm256_set1_pd(pz), _mm256_loadu_pd(z + 4 * half));
    const __m256d sum =
        _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(dx, dx), _mm256_mul_pd(dy, dy)), _mm256_mul_pd(dz, dz));
    bits |= static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(sum, _mm256_set1_pd(squared), _CMP_LE_OQ)))
            << (4 * half);
  }
  return bits;
#else
  unsigned bits = 0;
  for (int i = 0; i < kLanes; ++i) {
    const double dx = px - x[i], dy = py - y[i], dz = pz - z[i];
    bits |= static_cast<unsigned>(dx * dx + dy * dy + dz * dz <= squared) << i;
  }
  return bits;
#endif
}

std::int64_t SeparateBucket(const BucketArgs& a) {
  const int padded = (a.count + kLanes - 1) / kLanes * kLanes;
  double* x = a.scratch;
  double* y = x + padded;
  double* z = y + padded;
  for (int m = 0; m < a.count; ++m) {
    x[m] = a.x[0][a.members[m]];
    y[m] = a.x[1][a.members[m]];
    z[m] = a.x[2][a.members[m]];
  }
  for (int m = a.count; m < padded; ++m) x[m] = y[m] = z[m] = 1e300;  // near nothing: its square is infinite

  const double squared = a.greatestApart * a.greatestApart * (1 + 1e-12);  // squares round: rather look twice
  std::int64_t contacts = 0;
  for (int m = 0; m < a.count; ++m) {
    const double px = x[m], py = y[m], pz = z[m];
    double cx = 0, cy = 0, cz = 0;
    int count = 0;
    for (int base = 0; base < padded; base += kLanes) {
      unsigned bits = Within(x + base, y + base, z + base, px, py, pz, squared);
      if (m - base >= 0 && m - base < kLanes) bits &= ~(1u << (m - base));  // not itself
      for (; bits != 0; bits &= bits - 1) {
        const int o = base + __builtin_ctz(bits);
        const double apart = a.thickness[a.members[m]] + a.thickness[a.members[o]];
        const double dx = px - x[o], dy = py - y[o], dz = pz - z[o];
        const double distance = Sqrt(dx * dx + dy * dy + dz * dz);
        if (distance > apart) continue;
        const double push = apart - distance;
        if (distance > 0) {
          cx += dx / distance * push;
          cy += dy / distance * push;
          cz += dz / distance * push;
        } else {
          cy += push;  // points that coincide part along +y
        }
        ++count;
      }
    }
    contacts += count;
    if (count == 0 || a.fixed[a.members[m]]) continue;
    x[m] += cx / count / a.stepsPerFrame;
    y[m] += cy / count / a.stepsPerFrame;
    z[m] += cz / count / a.stepsPerFrame;
    a.x[0][a.members[m]] = x[m];
    a.x[1][a.members[m]] = y[m];
    a.x[2][a.members[m]] = z[m];
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
    case kInterpolate: return CollidePlaneBy<kInterpolate>(a);
    case kOffset: return CollidePlaneBy<kOffset>(a);
    default: return CollidePlaneBy<kHold>(a);
  }
}

}  // namespace

extern const Kernels kKernels = {PERCALE_KERNELS_NAME, Integrate,     MarkLongSprings, BoxKeys,
                                 SeparateBucket,       CollideSphere, CollidePlane};

}  // namespace percale::springs::PERCALE_KERNELS
