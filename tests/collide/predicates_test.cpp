#include "collide/predicates.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

#include "math/splitmix64.h"
#include "tests/sanitized.h"

using namespace percale;
using namespace percale::test;

namespace {

/// A whole number of any length, as slow as it is plain: the reference, which shares nothing with the predicates.
class Whole {
 public:
  Whole() = default;
  Whole(std::int64_t number) : negative_(number < 0) {  // NOLINT: implicit, so that formulas read well
    for (auto rest = static_cast<std::uint64_t>(negative_ ? -number : number); rest > 0; rest >>= 32)
      digits_.push_back(static_cast<std::uint32_t>(rest));
  }
  /// The double times 2^shift; its mantissa of 53 bits must come out whole.
  static Whole Of(double number, int shift) {
    if (number == 0) return {};
    int exponent = 0;
    const double mantissa = std::frexp(number, &exponent);  // 53 bits: whole times 2^-53
    Whole whole(static_cast<std::int64_t>(std::ldexp(mantissa, 53)));
    int left = exponent - 53 + shift;
    if (left < 0) FAIL("the shift is too small");
    for (; left >= 32; left -= 32) whole.digits_.insert(whole.digits_.begin(), 0);
    return whole * Whole(std::int64_t{1} << left);
  }

  int Sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }
  friend Whole operator-(Whole a) {
    a.negative_ = !a.negative_;
    return a;
  }
  friend Whole operator-(const Whole& a, const Whole& b) { return a + -b; }
  friend Whole operator+(const Whole& a, const Whole& b) {
    const bool swap = Smaller(a.digits_, b.digits_);
    const Whole &large = swap ? b : a, &small = swap ? a : b;
    Whole sum = large;
    const std::int64_t factor = large.negative_ == small.negative_ ? 1 : -1;
    std::int64_t carry = 0;
    for (std::size_t i = 0; i < sum.digits_.size(); ++i) {
      carry += std::int64_t(sum.digits_[i]) + factor * (i < small.digits_.size() ? std::int64_t(small.digits_[i]) : 0);
      sum.digits_[i] = static_cast<std::uint32_t>(carry & 0xffffffff);
      carry >>= 32;
    }
    if (carry > 0) sum.digits_.push_back(static_cast<std::uint32_t>(carry));
    sum.Trim();
    return sum;
  }
  friend Whole operator*(const Whole& a, const Whole& b) {
    Whole product;
    product.negative_ = a.negative_ != b.negative_;
    product.digits_.resize(a.digits_.size() + b.digits_.size());
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.digits_.size() || carry > 0; ++j) {
        carry += std::uint64_t(product.digits_[i + j]);
        if (j < b.digits_.size()) carry += std::uint64_t(a.digits_[i]) * b.digits_[j];
        product.digits_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    product.Trim();
    return product;
  }

 private:
  static bool Smaller(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    if (a.size() != b.size()) return a.size() < b.size();
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  }
  void Trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
  }

  bool negative_ = false;
  std::vector<std::uint32_t> digits_;  // the lowest first
};

template <class Number>
struct Point {
  Number x, y, z;
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};
template <class Number>
Number Dot(const Point<Number>& a, const Point<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Point<Number> Cross(const Point<Number>& a, const Point<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Doubles that are multiples of 2^-shift.
int ReferenceOrient3d(const std::array<Vec3, 4>& p, int shift) {
  std::array<Point<Whole>, 4> w;
  for (std::size_t i = 0; i < 4; ++i)
    w[i] = {Whole::Of(p[i].x, shift), Whole::Of(p[i].y, shift), Whole::Of(p[i].z, shift)};
  return Dot(w[0] - w[3], Cross(w[1] - w[3], w[2] - w[3])).Sign();
}
int ReferenceOrient2d(const std::array<Vec2, 3>& p, int shift) {
  std::array<std::array<Whole, 2>, 3> w;
  for (std::size_t i = 0; i < 3; ++i) w[i] = {Whole::Of(p[i].x, shift), Whole::Of(p[i].y, shift)};
  return ((w[0][0] - w[2][0]) * (w[1][1] - w[2][1]) - (w[0][1] - w[2][1]) * (w[1][0] - w[2][0])).Sign();
}

/// Both ways agree with the reference; returns the sign.
int CheckOrient3d(const std::array<Vec3, 4>& p, int shift) {
  const int sign = ReferenceOrient3d(p, shift);
  const int found = Orient3d(p[0], p[1], p[2], p[3]), exact = ExactOrient3d(p[0], p[1], p[2], p[3]);
  if (found != sign || exact != sign) {
    for (const Vec3& x : p) MESSAGE(x.x << " " << x.y << " " << x.z);
    CHECK(found == sign);
    CHECK(exact == sign);
  }
  return sign;
}

std::int64_t Uniform(SplitMix64& random, std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(random.Next() % static_cast<std::uint64_t>(high - low + 1));
}

/// A double of random digits, between 2^low and 2^high in size.
double Wild(SplitMix64& random, int low, int high) {
  const double size = 1 + random.NextUnit();
  const int exponent = static_cast<int>(Uniform(random, low, high));
  return std::ldexp(random.Next() % 2 == 0 ? size : -size, exponent);
}

using Lattice = Point<std::int64_t>;

/// Whether 0 is in the convex hull of some points: then it is in a point, segment, triangle or tetrahedron of them
/// (Caratheodory).
bool HullHasOrigin(const std::vector<Lattice>& w) {
  const auto none = [](const Lattice& a) { return a.x == 0 && a.y == 0 && a.z == 0; };
  const std::size_t n = w.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (none(w[i])) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (none(Cross(w[i], w[j])) && Dot(w[i], w[j]) <= 0) return true;
      for (std::size_t k = 0; k < j; ++k) {
        const Lattice normal = Cross(w[j] - w[i], w[k] - w[i]);
        if (!none(normal) && Dot(normal, w[i]) == 0 && Dot(normal, Cross(w[i], w[j])) >= 0 &&
            Dot(normal, Cross(w[j], w[k])) >= 0 && Dot(normal, Cross(w[k], w[i])) >= 0) {
          return true;
        }
        for (std::size_t l = 0; l < k; ++l) {
          const auto volume = [](const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& d) {
            return Dot(a - d, Cross(b - d, c - d));
          };
          const std::int64_t all = volume(w[i], w[j], w[k], w[l]);
          if (all == 0) continue;
          const std::int64_t sign = all > 0 ? 1 : -1;
          const Lattice o{0, 0, 0};
          if (volume(o, w[j], w[k], w[l]) * sign >= 0 && volume(w[i], o, w[k], w[l]) * sign >= 0 &&
              volume(w[i], w[j], o, w[l]) * sign >= 0 && volume(w[i], w[j], w[k], o) * sign >= 0) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

bool ReferenceMeets(const std::array<Lattice, 5>& p) {
  std::vector<Lattice> differences;
  for (std::size_t i : {0, 1}) {
    for (std::size_t j : {2, 3, 4}) differences.push_back(p[i] - p[j]);
  }
  return HullHasOrigin(differences);
}

}  // namespace

TEST_CASE("a point is above, below or in a plane") {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  CHECK(Orient3d(a, b, c, {0, 0, -1}) == 1);
  CHECK(Orient3d(a, b, c, {0, 0, 1}) == -1);
  CHECK(Orient3d(a, b, c, {5, -7, 0}) == 0);
  CHECK(Orient2d({0, 0}, {1, 0}, {0, 1}) == 1);
  CHECK(Orient2d({0, 0}, {0, 1}, {1, 0}) == -1);
  CHECK(Orient2d({0, 0}, {1, 3}, {2, 6}) == 0);
}

TEST_CASE("on a small lattice, where every ninth four lies in a plane, no sign is wrong at any size") {
  SplitMix64 random(1);
  int zeros = 0;
  for (int i = 0; i < Fewer(60000); ++i) {
    // Far from the origin the lattice's differences are still exact; very large and small ones are as well.
    const int scale = static_cast<int>(Uniform(random, -200, 200));
    const double far = random.Next() % 2 == 0 ? 0 : 1024;
    std::array<Vec3, 4> p;
    const auto coordinate = [&] { return std::ldexp(far + double(Uniform(random, -2, 2)), scale); };
    for (Vec3& x : p) x = {coordinate(), coordinate(), coordinate()};
    zeros += CheckOrient3d(p, 260) == 0 ? 1 : 0;
    std::array<Vec2, 3> q;
    for (Vec2& x : q) x = {coordinate(), coordinate()};
    CHECK(Orient2d(q[0], q[1], q[2]) == ReferenceOrient2d(q, 260));
  }
  CHECK(zeros > Fewer(5000));
}

TEST_CASE("of points within rounding of a plane, with all digits in use, no sign is wrong") {
  SplitMix64 random(2);
  std::array<int, 3> seen{};
  for (int i = 0; i < Fewer(60000); ++i) {
    std::array<Vec3, 4> p;
    const auto coordinate = [&] { return 2 * random.NextUnit() - 1; };
    const double offset = i % 3 == 0 ? 1000.0 : 0.0;
    for (std::size_t k = 0; k < 3; ++k) p[k] = {offset + coordinate(), offset + coordinate(), offset + coordinate()};
    const double s = coordinate(), t = coordinate();
    p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
    if (i % 2 == 0) p[3].z = std::nextafter(p[3].z, i % 4 == 0 ? 1e6 : -1e6);
    ++seen[std::size_t(1 + CheckOrient3d(p, 120))];
  }
  CHECK(seen[0] > Fewer(10000));
  CHECK(seen[2] > Fewer(10000));
}

TEST_CASE("of points within rounding of a line, with all digits in use, no sign is wrong") {
  SplitMix64 random(9);
  std::array<int, 3> seen{};
  for (int i = 0; i < Fewer(60000); ++i) {
    const double offset = i % 3 == 0 ? 1000.0 : 0.0;
    const auto coordinate = [&] { return offset + 2 * random.NextUnit() - 1; };
    std::array<Vec2, 3> p;
    for (std::size_t k = 0; k < 2; ++k) p[k] = {coordinate(), coordinate()};
    const double s = 3 * random.NextUnit() - 1;
    p[2] = {p[0].x + s * (p[1].x - p[0].x), p[0].y + s * (p[1].y - p[0].y)};
    std::swap(p[2], p[std::size_t(i % 3)]);
    const int sign = ReferenceOrient2d(p, 120);
    ++seen[std::size_t(1 + sign)];
    if (Orient2d(p[0], p[1], p[2]) == sign && ExactOrient2d(p[0], p[1], p[2]) == sign) continue;
    CHECK(Orient2d(p[0], p[1], p[2]) == sign);
    CHECK(ExactOrient2d(p[0], p[1], p[2]) == sign);
  }
  CHECK(seen[0] > Fewer(10000));
  CHECK(seen[2] > Fewer(10000));
}

TEST_CASE("of points in a plane whose differences do not fit into a double, no sign is wrong") {
  // p[3] is the middle of an edge, to the bit, of points of few digits at very different sizes: exactly 0. Moved by the
  // smallest step it is not.
  SplitMix64 random(3);
  int zeros = 0;
  for (int i = 0; i < Fewer(20000); ++i) {
    std::array<Vec3, 4> p;
    const auto coordinate = [&] {
      const auto digits = double(Uniform(random, -9, 9));
      return std::ldexp(digits, static_cast<int>(Uniform(random, -22, 22)));
    };
    for (std::size_t k = 0; k < 3; ++k) p[k] = {coordinate(), coordinate(), coordinate()};
    p[3] = 0.5 * (p[0] + p[1]);
    // A common large offset on one axis and small differences there: tails.
    const double tiny = std::ldexp(1, -60);
    if (i % 2 == 0) p[2].x += tiny * coordinate();
    zeros += CheckOrient3d(p, 250) == 0 ? 1 : 0;
    std::swap(p[3], p[std::size_t(i % 3)]);
    CheckOrient3d(p, 250);
    if (p[0].y != 0) p[0].y = std::nextafter(p[0].y, 1e9);
    CheckOrient3d(p, 250);
  }
  CHECK(zeros > Fewer(15000));
}

TEST_CASE("coordinates of very different sizes, to the ends of the range") {
  SplitMix64 random(4);
  for (int i = 0; i < Fewer(5000); ++i) {
    std::array<Vec3, 4> p;
    const auto coordinate = [&] { return random.Next() % 8 == 0 ? 0 : Wild(random, -298, 297); };
    for (Vec3& x : p) x = {coordinate(), coordinate(), coordinate()};
    CheckOrient3d(p, 360);
    if (i % 2 == 0) {  // in a plane but for what is lost to rounding
      p[3] = 0.5 * (p[0] + p[1]);
      CheckOrient3d(p, 1100);
    }
    const std::array<Vec2, 3> q = {Vec2{p[0].x, p[0].y}, Vec2{p[1].x, p[1].y}, Vec2{p[2].x, p[2].y}};
    CHECK(Orient2d(q[0], q[1], q[2]) == ReferenceOrient2d(q, 360));
    CHECK(ExactOrient2d(q[0], q[1], q[2]) == ReferenceOrient2d(q, 360));
  }
}

TEST_CASE("near the smallest coordinates products underflow, and no sign is wrong") {
  SplitMix64 random(5);
  for (int i = 0; i < Fewer(5000); ++i) {
    std::array<Vec3, 4> p;
    const auto coordinate = [&] { return Wild(random, -298, -290); };
    for (Vec3& x : p) x = {coordinate(), coordinate(), coordinate()};
    if (i % 2 == 0) {
      const double s = random.NextUnit();
      p[3] = p[0] + s * (p[1] - p[0]);
      if (std::min({std::abs(p[3].x), std::abs(p[3].y), std::abs(p[3].z)}) < kSmallestExact) continue;
    }
    CheckOrient3d(p, 360);
  }
}

TEST_CASE("two points swapped turn the sign") {
  SplitMix64 random(6);
  for (int i = 0; i < Fewer(3000); ++i) {
    std::array<Vec3, 4> p;
    for (Vec3& x : p) x = {random.NextUnit(), random.NextUnit(), random.NextUnit()};
    if (i % 2 == 0) p[3] = p[0] + 0.3 * (p[1] - p[0]) + 0.3 * (p[2] - p[0]);
    const int sign = Orient3d(p[0], p[1], p[2], p[3]);
    for (const auto& [j, k] : {std::pair{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}) {
      std::array<Vec3, 4> q = p;
      std::swap(q[std::size_t(j)], q[std::size_t(k)]);
      CHECK(Orient3d(q[0], q[1], q[2], q[3]) == -sign);
    }
  }
}

TEST_CASE("a segment and a triangle of a lattice meet just when their difference has the origin, collapsed or not") {
  SplitMix64 random(7);
  int meeting = 0;
  for (int i = 0; i < Fewer(200000); ++i) {
    // Flat in a third of the cases, on a line in some.
    const std::int64_t size = 1 + i % 3;
    const int flat = i % 9;
    std::array<Lattice, 5> p;
    for (Lattice& x : p) {
      x = {Uniform(random, -size, size), Uniform(random, -size, size), Uniform(random, -size, size)};
      if (flat == 0) x.z = x.x + x.y;
      if (flat == 1) x.z = 1;
      if (flat == 2) x.y = x.z = 2 * x.x;
    }
    const bool expected = ReferenceMeets(p);
    meeting += expected ? 1 : 0;
    std::array<Vec3, 5> v;
    const double scale = i % 2 == 0 ? 1 : 0.1;  // rounded, but each coordinate alike: still what it was
    for (std::size_t k = 0; k < 5; ++k) v[k] = {scale * double(p[k].x), scale * double(p[k].y), scale * double(p[k].z)};
    if (i % 2 != 0 && flat != 1) continue;
    const bool found = SegmentMeetsTriangle(v[0], v[1], v[2], v[3], v[4]);
    if (found != expected) {
      for (const Vec3& x : v) MESSAGE(x.x << " " << x.y << " " << x.z);
      CHECK(found == expected);
    }
    if (i % 16 == 0) {
      CHECK(SegmentMeetsTriangle(v[1], v[0], v[3], v[4], v[2]) == expected);
      CHECK(SegmentMeetsTriangle(v[0], v[1], v[4], v[3], v[2]) == expected);
    }
  }
  CHECK(meeting > Fewer(20000));
}

TEST_CASE("a segment along a side of a triangle, of so many digits that products are rounded") {
  SplitMix64 random(10);
  for (int i = 0; i < Fewer(20000); ++i) {
    const auto corner = [&] {
      constexpr std::int64_t kMost = std::int64_t{1} << 40;
      const auto coordinate = [&] { return 8 * double(Uniform(random, -kMost, kMost)); };
      const double x = coordinate(), y = coordinate();
      return Vec3{x, y, coordinate()};
    };
    const Vec3 a = corner(), b = corner(), c = corner();
    const double share = double(Uniform(random, 1, 12)) / 8;
    const Vec3 q = a + share * (b - a);  // exact
    const bool both = SegmentRunsOnTriangle(q, a, b, c) && SegmentRunsOnTriangle(q, a, c, b);
    const bool none = SegmentRunsOnTriangle(a - share * (b - a), a, b, c);
    if (both && !none) continue;
    CHECK(both);
    CHECK_FALSE(none);
  }
}

TEST_CASE("a segment from a corner runs on a triangle just when the rest of it meets the triangle") {
  SplitMix64 random(8);
  int running = 0;
  for (int i = 0; i < Fewer(60000); ++i) {
    const std::int64_t size = 1 + i % 2;
    std::array<Lattice, 4> p;  // q, a, b, c
    for (Lattice& x : p) {
      x = {Uniform(random, -size, size), Uniform(random, -size, size), Uniform(random, -size, size)};
      if (i % 3 == 0) x.z = x.x - x.y;
      if (i % 12 == 0) x.z = 0;
    }
    // Where the direction of q is in the triangle's angle, a short enough part of the segment ends on the triangle. A
    // hundredth is short enough on this lattice; coordinates are in units of one.
    constexpr std::int64_t kUnit = 100;
    const auto fine = [&](const Lattice& x) { return Lattice{kUnit * x.x, kUnit * x.y, kUnit * x.z}; };
    const Lattice way = p[0] - p[1], a = fine(p[1]);
    const Lattice near{a.x + way.x, a.y + way.y, a.z + way.z};
    const bool expected = ReferenceMeets({near, near, a, fine(p[2]), fine(p[3])});
    running += expected ? 1 : 0;
    const auto place = [](const Lattice& x) { return Vec3{double(x.x), double(x.y), double(x.z)}; };
    CHECK(SegmentRunsOnTriangle(place(p[0]), place(p[1]), place(p[2]), place(p[3])) == expected);
    CHECK(SegmentRunsOnTriangle(place(p[0]), place(p[1]), place(p[3]), place(p[2])) == expected);
  }
  CHECK(running > Fewer(3000));
}
