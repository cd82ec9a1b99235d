#include "collide/predicates.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstddef>

namespace percale {
namespace {

// Every operation below must round to double once, to nearest; the build has -ffp-contract=off.
#ifdef __FAST_MATH__
#error "expansions are wrong with -ffast-math; compile this file without it"
#endif
static_assert(FLT_EVAL_METHOD == 0, "expansions need arithmetic in double precision alone");

constexpr double kHalfUlp = 0x1p-53;  // the greatest relative error u of a rounded result

// The filters. Of a determinant, each product of coordinates passes at most 8 roundings in 3D (three differences, two
// products, the difference of a minor, two sums) and 4 in 2D (two differences, a product, a difference), each a factor
// 1 + e with |e| <= u. So its error is at most ((1 + u)^8 - 1) times the sum of the products' sizes, and that sum is at
// most (1 - u)^-8 times its own rounded value: 8.1 u times that in 3D, 4.1 u in 2D. The rest of the factors is for the
// rounding of the bound itself.
constexpr double kFilter3d = 9 * kHalfUlp;
constexpr double kFilter2d = 5 * kHalfUlp;
// Nothing underflows: a coordinate of kSmallestExact or more is a multiple of 2^-351, so each difference is, and each
// product a multiple of 2^-1053.

/// Whether the way w from the corner of a triangle is certain not to be a sum s u + t v, s and t >= 0, of the ways u
/// and v along its sides. Of such a sum, (u x v) (u x w) = t (u x v)^2 and (u x v) (w x v) = s (u x v)^2 are not
/// negative. Both are written by Lagrange's identity. Each product of coordinates passes 12 roundings; the sum of their
/// sizes is at most 2 u^2 |v| |w| <= u^2 (v^2 + w^2), and the same with u and v exchanged.
bool LeavesAngle(const Vec3& w, const Vec3& u, const Vec3& v) {
  constexpr double kFilter = 16 * kHalfUlp;
  constexpr double kLost = 1e-140;  // by underflow: some 2^-1075, times at most 3 (2 kLargestExact)^2 each
  const double uu = Dot(u, u), vv = Dot(v, v), ww = Dot(w, w), uv = Dot(u, v), uw = Dot(u, w), vw = Dot(v, w);
  return uu * vw - uw * uv < -(kFilter * uu * (vv + ww) + kLost) ||
         vv * uw - vw * uv < -(kFilter * vv * (uu + ww) + kLost);
}

constexpr int kUnsure = 2;

/// Orient3d where plain arithmetic decides, else kUnsure.
int QuickOrient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ax = a.x - d.x, ay = a.y - d.y, az = a.z - d.z;
  const double bx = b.x - d.x, by = b.y - d.y, bz = b.z - d.z;
  const double cx = c.x - d.x, cy = c.y - d.y, cz = c.z - d.z;
  const double bxcy = bx * cy, cxby = cx * by, cxay = cx * ay, axcy = ax * cy, axby = ax * by, bxay = bx * ay;
  const double determinant = az * (bxcy - cxby) + bz * (cxay - axcy) + cz * (axby - bxay);
  const double size = (std::abs(bxcy) + std::abs(cxby)) * std::abs(az) +
                      (std::abs(cxay) + std::abs(axcy)) * std::abs(bz) +
                      (std::abs(axby) + std::abs(bxay)) * std::abs(cz);
  const double bound = kFilter3d * size;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  if (size == 0) return 0;  // a difference of 0 in each product, as in a plane across an axis: cloth starts in such
  return kUnsure;
}

// --- Expansions: sums of doubles that do not overlap, the smallest first, without zeros; an empty one is 0. ---

struct Two {
  double high, low;
};

/// a + b = high + low (Knuth; Shewchuk, theorem 7).
Two ExactSum(double a, double b) {
  const double high = a + b;
  const double shareOfB = high - a, shareOfA = high - shareOfB;
  return {high, (a - shareOfA) + (b - shareOfB)};
}

/// The same where |a| >= |b| (Dekker; theorem 6).
Two ExactSumOrdered(double a, double b) {
  const double high = a + b;
  return {high, b - (high - a)};
}

/// a as two numbers of at most 26 bits (Dekker; theorem 17).
Two Split(double a) {
  const double c = 134217729.0 * a;  // 2^27 + 1
  const double high = c - (c - a);
  return {high, a - high};
}

/// a b = high + low (Dekker; theorem 18).
Two ExactProduct(double a, double b) {
  const double high = a * b;
  const Two x = Split(a), y = Split(b);
  return {high, x.low * y.low - (((high - x.high * y.high) - x.low * y.high) - x.high * y.low)};
}

/// h = e + f, and its length: at most m + n. By merging (fast expansion sum, theorem 13). h is neither e nor f.
int Sum(const double* e, int m, const double* f, int n, double* h) {
  int length = 0;
  double q = 0;
  for (int i = 0, j = 0; i + j < m + n;) {
    const bool ofE = j == n || (i < m && std::abs(e[i]) <= std::abs(f[j]));
    const Two sum = ExactSum(q, ofE ? e[i++] : f[j++]);
    if (sum.low != 0) h[length++] = sum.low;
    q = sum.high;
  }
  if (q != 0) h[length++] = q;
  return length;
}

/// h = b e, and its length: at most 2 m (theorem 19).
int Scale(const double* e, int m, double b, double* h) {
  if (m == 0 || b == 0) return 0;
  int length = 0;
  Two q = ExactProduct(e[0], b);
  if (q.low != 0) h[length++] = q.low;
  for (int i = 1; i < m; ++i) {
    const Two product = ExactProduct(e[i], b);
    const Two lower = ExactSum(q.high, product.low);
    if (lower.low != 0) h[length++] = lower.low;
    q = ExactSumOrdered(product.high, lower.high);
    if (q.low != 0) h[length++] = q.low;
  }
  if (q.high != 0) h[length++] = q.high;
  return length;
}

/// An expansion of known greatest length.
template <int kMost>
struct Expansion {
  int length = 0;
  double part[kMost];  // NOLINT: only the first `length` are ever read

  int Sign() const { return length == 0 ? 0 : part[length - 1] > 0 ? 1 : -1; }
};

Expansion<2> Difference(double a, double b) {
  const Two difference = ExactSum(a, -b);
  Expansion<2> e;
  if (difference.low != 0) e.part[e.length++] = difference.low;
  if (difference.high != 0) e.part[e.length++] = difference.high;
  return e;
}

template <int kM, int kN>
Expansion<kM + kN> operator+(const Expansion<kM>& e, const Expansion<kN>& f) {
  Expansion<kM + kN> h;
  h.length = Sum(e.part, e.length, f.part, f.length, h.part);
  return h;
}

template <int kM>
Expansion<kM> operator-(Expansion<kM> e) {
  for (int i = 0; i < e.length; ++i) e.part[i] = -e.part[i];
  return e;
}

/// A product with the difference of two numbers, which has one part or two.
template <int kM>
Expansion<4 * kM> operator*(const Expansion<kM>& e, const Expansion<2>& f) {
  Expansion<4 * kM> h;
  if (f.length == 0) return h;
  if (f.length == 1) {
    h.length = Scale(e.part, e.length, f.part[0], h.part);
    return h;
  }
  double low[2 * kM], high[2 * kM];
  const int m = Scale(e.part, e.length, f.part[0], low), n = Scale(e.part, e.length, f.part[1], high);
  h.length = Sum(low, m, high, n, h.part);
  return h;
}

/// a d - b c
Expansion<16> Minor(const Expansion<2>& a, const Expansion<2>& b, const Expansion<2>& c, const Expansion<2>& d) {
  return a * d + -(b * c);
}

// --- In a plane ---

// Whether things in one plane of space meet is asked of their shadows along the three axes. Along at least one axis the
// plane, or the line or point that it may be, casts a shadow in which no two of its points fall together: there the
// shadows meet just when the things do. Along the others they meet if the things do. So the things meet just when all
// three shadows meet, and no axis has to be chosen.
using Shadow = Vec2 (*)(const Vec3&);
constexpr Shadow kShadows[] = {[](const Vec3& x) {
                                 return Vec2{x.y, x.z};
                               },
                               [](const Vec3& x) {
                                 return Vec2{x.z, x.x};
                               },
                               [](const Vec3& x) {
                                 return Vec2{x.x, x.y};
                               }};

/// The shadows, and first the one in which a triangle is largest: most questions end there.
std::array<Shadow, 3> ShadowsOf(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = Cross(b - a, c - a);
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const std::size_t first = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  return {kShadows[first], kShadows[(first + 1) % 3], kShadows[(first + 2) % 3]};
}

int Sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

bool IntervalsMeet(double a, double b, double c, double d) {
  return std::min(a, b) <= std::max(c, d) && std::min(c, d) <= std::max(a, b);
}

bool SegmentsMeet(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b) {
  // The intervals decide where all four lie on a line, and follow where they do not.
  return IntervalsMeet(p.x, q.x, a.x, b.x) && IntervalsMeet(p.y, q.y, a.y, b.y) &&
         Orient2d(p, q, a) * Orient2d(p, q, b) <= 0 && Orient2d(a, b, p) * Orient2d(a, b, q) <= 0;
}

bool SegmentMeetsTriangle(const Vec2& p, const Vec2& q, const Vec2& a, const Vec2& b, const Vec2& c) {
  const int turn = Orient2d(a, b, c);
  if (turn == 0) return SegmentsMeet(p, q, a, b) || SegmentsMeet(p, q, b, c) || SegmentsMeet(p, q, c, a);
  // Of two convex shapes that lie apart, the line of some side has them on its two sides.
  const auto beyond = [&](const Vec2& from, const Vec2& to) {
    return Orient2d(from, to, p) * turn < 0 && Orient2d(from, to, q) * turn < 0;
  };
  if (beyond(a, b) || beyond(b, c) || beyond(c, a)) return false;
  const int sideOfA = Orient2d(p, q, a);
  return sideOfA == 0 || sideOfA * Orient2d(p, q, b) <= 0 || sideOfA * Orient2d(p, q, c) <= 0;
}

/// Whether q - a is a multiple >= 0 of b - a, where a, b and q lie on a line.
bool RunsAlong(const Vec2& q, const Vec2& a, const Vec2& b) {
  if (q == a) return true;
  return Sign(q.x - a.x) == Sign(b.x - a.x) && Sign(q.y - a.y) == Sign(b.y - a.y);
}

/// Whether q - a is a sum of multiples >= 0 of b - a and c - a.
bool RunsBetween(const Vec2& q, const Vec2& a, const Vec2& b, const Vec2& c) {
  const int turn = Orient2d(a, b, c), fromB = Orient2d(a, b, q), toC = Orient2d(a, q, c);
  if (turn != 0) return fromB * turn >= 0 && toC * turn >= 0;
  return fromB == 0 && toC == 0 && (RunsAlong(q, a, b) || RunsAlong(q, a, c));
}

}  // namespace

int ExactOrient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto ax = Difference(a.x, d.x), ay = Difference(a.y, d.y), az = Difference(a.z, d.z);
  const auto bx = Difference(b.x, d.x), by = Difference(b.y, d.y), bz = Difference(b.z, d.z);
  const auto cx = Difference(c.x, d.x), cy = Difference(c.y, d.y), cz = Difference(c.z, d.z);
  return (Minor(bx, by, cx, cy) * az + Minor(cx, cy, ax, ay) * bz + Minor(ax, ay, bx, by) * cz).Sign();
}

int ExactOrient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  return Minor(Difference(a.x, c.x), Difference(a.y, c.y), Difference(b.x, c.x), Difference(b.y, c.y)).Sign();
}

int Orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int quick = QuickOrient3d(a, b, c, d);
  return quick == kUnsure ? ExactOrient3d(a, b, c, d) : quick;
}

int Orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double bound = kFilter2d * (std::abs(left) + std::abs(right));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  if (left == 0 && right == 0) return 0;
  return ExactOrient2d(a, b, c);
}

bool SegmentMeetsTriangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int quickP = QuickOrient3d(a, b, c, p), quickQ = QuickOrient3d(a, b, c, q);
  if (quickP * quickQ == 1) return false;
  const std::array<Shadow, 3> shadows = ShadowsOf(a, b, c);
  const auto shadowsMeet = [&](const auto& meet) { return std::all_of(shadows.begin(), shadows.end(), meet); };
  const auto meet = [&](Shadow of) { return SegmentMeetsTriangle(of(p), of(q), of(a), of(b), of(c)); };
  // In the same plane, or nearly: what has shadows that lie apart lies apart itself, which saves exact arithmetic.
  const auto perhapsZero = [](int quick) { return quick == 0 || quick == kUnsure; };
  if (perhapsZero(quickP) && perhapsZero(quickQ) && !meet(shadows[0])) return false;
  const int sideOfP = quickP == kUnsure ? ExactOrient3d(a, b, c, p) : quickP;
  const int sideOfQ = quickQ == kUnsure ? ExactOrient3d(a, b, c, q) : quickQ;
  if (sideOfP * sideOfQ > 0) return false;
  if (sideOfP != 0 || sideOfQ != 0) {
    // The line p q has one point in the triangle's plane, between p and q. It is where the line passes all sides of the
    // triangle the same way round.
    const int ab = Orient3d(p, q, a, b), bc = Orient3d(p, q, b, c);
    if (ab * bc < 0) return false;
    const int ca = Orient3d(p, q, c, a);
    return ab * ca >= 0 && bc * ca >= 0;
  }
  const bool collapsed = shadowsMeet([&](Shadow of) { return Orient2d(of(a), of(b), of(c)) == 0; });
  if (!collapsed) return shadowsMeet(meet);
  // A triangle on a line is its sides, and the segment need not lie in a plane with all of it.
  const auto meetsSide = [&](const Vec3& from, const Vec3& to) {
    return Orient3d(p, q, from, to) == 0 &&
           shadowsMeet([&](Shadow of) { return SegmentsMeet(of(p), of(q), of(from), of(to)); });
  };
  return meetsSide(a, b) || meetsSide(b, c) || meetsSide(c, a);
}

bool SegmentRunsOnTriangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (LeavesAngle(q - a, b - a, c - a) || Orient3d(a, b, c, q) != 0) return false;
  const std::array<Shadow, 3> shadows = ShadowsOf(a, b, c);
  return std::all_of(shadows.begin(), shadows.end(),
                     [&](Shadow of) { return RunsBetween(of(q), of(a), of(b), of(c)); });
}

}  // namespace percale
