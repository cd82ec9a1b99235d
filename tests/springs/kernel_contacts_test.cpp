// Boxes of the spatial map, and points that push each other apart, by themselves: against the rules of the
// classic simulator taken literally.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "math/splitmix64.h"
#include "tests/springs/kernel_arrays.h"

using namespace percale;
using namespace percale::springs;
using namespace percale::test;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMostBoxes = 0x1p20;  // from the origin; farther away box indices come round

/// Points and their keys, and what a kernel says that changed.
struct Boxes {
  Boxes(int count, const double (&size)[3])
      : x(2, count), key(At(count), ~std::uint64_t{0}), place(At(count)), changed(At(count)) {
    std::copy_n(size, 3, boxSize);
  }

  std::uint64_t ExpectedKey(std::int64_t point) const {
    std::uint64_t result = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto index = static_cast<std::int64_t>(std::floor(x(axis, point) / boxSize[axis]));
      result |= (static_cast<std::uint64_t>(index) & 0x1fffff) << 21 * axis;
    }
    return result;
  }

  /// How far a point is from the lower end of its box along an axis, in units of places, beyond what its place says.
  double PlaceError(std::int64_t point, int axis) const {
    const double longest = *std::max_element(boxSize, boxSize + 3);
    const double at = x(axis, point) / boxSize[axis];
    const auto told = static_cast<double>(place[At(point)] >> 16 * axis & 0xffff);
    return (at - std::floor(at)) * boxSize[axis] / longest * (1 << kPlaceBits) - told;
  }

  /// Brings the keys and places up to date; what is wrong with them, or nothing.
  std::string Fault(const Kernels& kernels) {
    constexpr int kFirst = 100;
    const std::vector<std::uint64_t> before = key;
    wraps = 0;
    BoxKeyArgs args{};
    args.firstPoint = kFirst;
    args.count = x.size;
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = x.axis(axis), args.boxSize[axis] = boxSize[axis];
    args.key = key.data();
    args.place = place.data();
    args.changed = changed.data();
    args.wraps = &wraps;
    const std::int64_t count = kernels.boxKeys(args);
    std::int64_t expectedCount = 0;
    bool far = false, near = true;
    for (int p = 0; p < x.size; ++p) {
      const std::uint64_t expected = ExpectedKey(p);
      if (key[At(p)] != expected) {
        char text[160];
        std::snprintf(text, sizeof text, "%s: point %d at %a, %a, %a has a wrong key", kernels.name, p, x(0, p),
                      x(1, p), x(2, p));
        return text;
      }
      const bool changes = expected != before[At(p)];
      if (place[At(p)] >> 48 != 0) return "a place that is more than three numbers";
      for (int axis = 0; axis < 3; ++axis) {
        const double index = std::floor(x(axis, p) / boxSize[axis]);
        const double error = PlaceError(p, axis);
        if (std::abs(index) < kMostBoxes && !(error > -0.01 && error < kPlaceError)) return "a place that is wrong";
        far = far || (changes && (index >= kMostBoxes || index < -kMostBoxes));
        near = near && std::abs(index) < kMostBoxes - 1;
      }
      if (!changes) continue;
      if (expectedCount >= count || changed[At(expectedCount)] != kFirst + p) return "a change that is not listed";
      ++expectedCount;
    }
    if (count != expectedCount) return "a change that was none";
    if (far && wraps == 0) return "boxes that may share a key, untold";
    if (near && wraps != 0) return "no box may share a key, though it was told";
    return "";
  }

  Axes x;
  std::vector<std::uint64_t> key, place;
  std::vector<std::int32_t> changed;
  double boxSize[3];
  std::uint8_t wraps = 0;
};

constexpr double kSizes[][3] = {{0.06, 0.06, 0.06},
                                {1.0 / 3, 0.1, 1.0 / 3},
                                {3 * 0.7 / 31, 3 * 1.3 / 47, 3 * 1.3 / 47},
                                {0.125, 2, 2},
                                {1e-5, 3e-5, 3e-5},
                                {7, 5, 7},
                                {0.0612, 0.0009, 0.0612},
                                {1e3, 1e2, 1e3}};

/// A coordinate where floors are hard to tell: on the side of a box or a few ulps away from it.
double NearSide(double size, double index, SplitMix64& random) {
  double at = index * size;
  const double way = random.Next() % 2 == 0 ? kInfinity : -kInfinity;
  for (std::uint64_t ulps = random.Next() % 4; ulps > 0; --ulps) at = std::nextafter(at, way);
  return at;
}

}  // namespace

TEST_CASE("keys are floors, on the sides of boxes and a few ulps away from them") {
  SplitMix64 random(40);
  for (const auto& size : kSizes) {
    for (const double range : {4.0, 100.0, 1e4, kMostBoxes - 2, 0x1p22, 0x1p30, 0x1p49}) {
      for (int count = 0; count <= 35; ++count) {
        for (const Kernels* kernels : RunnableKernels()) {
          Boxes boxes(count, size);
          for (int round = 0; round < 6; ++round) {
            for (int p = 0; p < count; ++p) {
              if (round > 0 && random.Next() % 3 != 0) continue;  // most keep their boxes
              for (int axis = 0; axis < 3; ++axis) {
                const double index = std::floor((2 * random.NextUnit() - 1) * range);
                boxes.x(axis, p) = random.Next() % 4 == 0 ? size[axis] * (index + random.NextUnit())
                                                          : NearSide(size[axis], index, random);
              }
            }
            CAPTURE(size[0]);
            CAPTURE(range);
            CAPTURE(count);
            REQUIRE(boxes.Fault(*kernels) == "");
          }
        }
      }
    }
  }
}

TEST_CASE("keys of zeros, of the smallest numbers and of those beside the ends of the indices") {
  for (const auto& size : kSizes) {
    for (int axis = 0; axis < 3; ++axis) {
      const double least = std::numeric_limits<double>::denorm_min(), end = kMostBoxes * size[axis];
      for (const double at :
           {0.0,   -0.0,   least, -least, 0x1p-1022, -0x1p-1022, 1e-300,  -1e-300,  1e-17,        -1e-17,
            1e-10, -1e-10, end,   -end,   2 * end,   -2 * end,   4 * end, -4 * end, 0x1p30 * end, -0x1p30 * end}) {
        for (const double away : {at, std::nextafter(at, kInfinity), std::nextafter(at, -kInfinity)}) {
          for (const Kernels* kernels : RunnableKernels()) {
            CAPTURE(size[axis]);
            CAPTURE(away);
            Boxes boxes(16, size);
            for (int p = 0; p < 16; p += 3) boxes.x(axis, p) = away;
            REQUIRE(boxes.Fault(*kernels) == "");
            CHECK((boxes.wraps != 0 || std::abs(away) < end));
          }
        }
      }
    }
  }
}

TEST_CASE("keys of points that walk through boxes, near and far, or leap") {
  SplitMix64 random(41);
  for (const auto& size : kSizes) {
    for (const double start : {0.0, 1e3, kMostBoxes, 2 * kMostBoxes, 3 * kMostBoxes, 4 * kMostBoxes, 0x1p26}) {
      for (const double sign : {1.0, -1.0}) {
        for (const Kernels* kernels : RunnableKernels()) {
          constexpr int kCount = 24;
          Boxes boxes(kCount, size);
          double index[3][kCount];  // with a part after the point
          for (auto& axis : index) {
            for (double& i : axis) i = sign * start + 6 * random.NextUnit() - 3;
          }
          for (int round = 0; round < 60; ++round) {
            for (int axis = 0; axis < 3; ++axis) {
              for (int p = 0; p < kCount; ++p) {
                index[axis][p] += 0.3 * (random.NextUnit() - 0.5);
                boxes.x(axis, p) = size[axis] * index[axis][p];
              }
            }
            CAPTURE(size[0]);
            CAPTURE(start);
            CAPTURE(sign);
            CAPTURE(round);
            REQUIRE(boxes.Fault(*kernels) == "");
          }
          // Far away and back: indices that agree in the bits of a key are no reason not to look.
          for (const double leap : {0x1p21, 0x1p22, 0x1p30, 0x1p40}) {
            for (int axis = 0; axis < 3; ++axis) {
              for (int p = 0; p < kCount; ++p) boxes.x(axis, p) = size[axis] * (index[axis][p] + sign * leap);
            }
            REQUIRE(boxes.Fault(*kernels) == "");
            for (int axis = 0; axis < 3; ++axis) {
              for (int p = 0; p < kCount; ++p) boxes.x(axis, p) = size[axis] * index[axis][p];
            }
            REQUIRE(boxes.Fault(*kernels) == "");
          }
        }
      }
    }
  }
}

namespace {

/// Buckets of points, and all that a kernel needs to part them.
struct Buckets {
  explicit Buckets(const std::vector<int>& sizes) : x(2, Sum(sizes)), count(sizes) {
    for (const int size : sizes) {
      first.push_back(static_cast<std::int32_t>(members.size()));
      members.resize(members.size() + At(size) + 2, 0);  // buckets need not lie side by side
    }
    members.resize(members.size() + 9, 0);
    fixed.assign(At(x.size), 0);
    thickness.assign(At(x.size), 0);
    mostPoints = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
  }

  static int Sum(const std::vector<int>& sizes) {
    int sum = 0;
    for (const int size : sizes) sum += size;
    return sum;
  }
  std::int32_t Member(std::size_t bucket, int m) const { return members[At(first[bucket] + m)]; }

  /// Deals the points out to the buckets, ascending in each.
  void Deal(SplitMix64& random) {
    std::vector<std::int32_t> places;  // the bucket of each point
    for (std::size_t b = 0; b < count.size(); ++b)
      places.insert(places.end(), At(count[b]), static_cast<std::int32_t>(b));
    for (std::size_t i = places.size(); i > 1; --i) std::swap(places[i - 1], places[random.Next() % i]);
    std::vector<int> dealt(count.size(), 0);
    for (std::size_t p = 0; p < places.size(); ++p) {
      const std::size_t b = At(places[p]);
      members[At(first[b] + dealt[b]++)] = static_cast<std::int32_t>(p);
    }
  }

  /// Where each point is in a box of the size `span` that holds its bucket: to within what is allowed, and mostly not
  /// better.
  std::vector<std::uint64_t> Places() const {
    std::vector<std::uint64_t> places(At(x.size));
    for (std::size_t b = 0; b < count.size(); ++b) {
      for (int axis = 0; axis < 3; ++axis) {
        double corner = kInfinity;
        for (int m = 0; m < count[b]; ++m) corner = std::min(corner, x(axis, Member(b, m)));
        for (int m = 0; m < count[b]; ++m) {
          const std::int32_t p = Member(b, m);
          const double units = (x(axis, p) - corner) / span * (1 << kPlaceBits), less = 0.7 * ((p + axis) % 3);
          const double told = std::clamp(std::floor(units - less), 0.0, (1 << kPlaceBits) - 1.0);
          places[At(p)] |= static_cast<std::uint64_t>(told) << 16 * axis;
        }
      }
    }
    return places;
  }

  std::int64_t Separate(const Kernels& kernels) {
    const std::vector<std::uint64_t> places = span < kInfinity ? Places() : std::vector<std::uint64_t>{};
    std::vector<double> scratch(3 * At(mostPoints + kGridPad));
    std::vector<std::int32_t> others(At(mostPoints));
    BucketArgs args{};
    args.bucketBegin = 0;
    args.bucketEnd = static_cast<int>(count.size());
    args.first = first.data();
    args.count = count.data();
    args.members = members.data();
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = x.axis(axis);
    args.fixed = fixed.data();
    args.thickness = thickness.data();
    const auto [least, most] = std::minmax_element(thickness.begin(), thickness.end());
    args.greatestApart = 2 * *most;
    args.sameThickness = *least == *most;
    args.place = span < kInfinity ? places.data() : nullptr;
    args.boxSize = span;
    args.stepsPerFrame = stepsPerFrame;
    args.scratch = scratch.data();
    args.others = others.data();
    return kernels.separateBuckets(args);
  }

  std::int64_t SeparatePlainly() {
    std::int64_t contacts = 0;
    for (std::size_t b = 0; b < count.size(); ++b) {
      for (int m = 0; m < count[b]; ++m) {
        const std::int32_t p = Member(b, m);
        double correction[3] = {0, 0, 0};
        int pushes = 0;
        for (int o = 0; o < count[b]; ++o) {
          const std::int32_t q = Member(b, o);
          if (q == p) continue;
          const double apart = thickness[At(p)] + thickness[At(q)];
          const double d[3] = {x(0, p) - x(0, q), x(1, p) - x(1, q), x(2, p) - x(2, q)};
          const double distance = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
          if (distance > apart) continue;
          ++pushes;
          for (int axis = 0; axis < 3; ++axis) {
            correction[axis] += distance > 0 ? d[axis] * ((apart - distance) / distance) : axis == 1 ? apart : 0;
          }
        }
        contacts += pushes;
        if (pushes == 0 || fixed[At(p)] != 0) continue;
        for (int axis = 0; axis < 3; ++axis) x(axis, p) += correction[axis] / (pushes * stepsPerFrame);
      }
    }
    return contacts;
  }

  Axes x;
  std::vector<std::int32_t> first, count, members;
  std::vector<std::uint8_t> fixed;
  std::vector<double> thickness;
  int mostPoints = 0;
  double span = kInfinity, stepsPerFrame = 30;
};

enum class Cluster { Loose, AtTheLimit, Coincident, Dense, Flat, kCount };

/// Places the points of a bucket within a box, not far from each other.
void Place(Buckets& b, std::size_t bucket, Cluster cluster, double box, SplitMix64& random) {
  const auto noise = [&] { return 2 * random.NextUnit() - 1; };
  double corner[3];
  for (double& c : corner) c = box * static_cast<double>(static_cast<int>(random.Next() % 41) - 20);
  for (int m = 0; m < b.count[bucket]; ++m) {
    const std::int32_t p = b.Member(bucket, m);
    const std::int32_t earlier =
        b.Member(bucket, m == 0 ? 0 : static_cast<int>(random.Next() % static_cast<std::uint64_t>(m)));
    const double apart = b.thickness[At(p)] + b.thickness[At(earlier)];
    for (int axis = 0; axis < 3; ++axis) b.x(axis, p) = corner[axis] + box * random.NextUnit();
    if (cluster == Cluster::Flat) b.x(2, p) = random.Next() % 2 == 0 ? 0.0 : -0.0;
    if (m == 0) continue;
    if (cluster == Cluster::Coincident && random.Next() % 2 == 0) {
      for (int axis = 0; axis < 3; ++axis) b.x(axis, p) = b.x(axis, earlier);
    }
    if (cluster == Cluster::Dense) {
      const std::int32_t middle = b.Member(bucket, 0);
      for (int axis = 0; axis < 3; ++axis) b.x(axis, p) = b.x(axis, middle) + 0.5 * apart * noise();
    }
    if (cluster == Cluster::AtTheLimit) {
      // Along an axis or aslant, and a few ulps to and fro.
      double direction[3] = {0, 0, 0};
      if (random.Next() % 2 == 0) {
        direction[random.Next() % 3] = random.Next() % 2 == 0 ? 1 : -1;
      } else {
        for (double& d : direction) d = noise();
      }
      const double length = std::hypot(direction[0], direction[1], direction[2]);
      for (int axis = 0; axis < 3; ++axis) b.x(axis, p) = b.x(axis, earlier) + apart * direction[axis] / length;
      double& x = b.x(static_cast<int>(random.Next() % 3), p);
      for (std::uint64_t ulps = random.Next() % 4; ulps > 0; --ulps) x = std::nextafter(x, noise() < 0 ? -1e9 : 1e9);
    }
    // Within a bucket coordinates differ by no more than the box is large.
    for (int axis = 0; axis < 3; ++axis) {
      double& x = b.x(axis, p);
      if (x < corner[axis] || x > corner[axis] + box) x = corner[axis] + box * random.NextUnit();
    }
    if (cluster == Cluster::Flat) b.x(2, p) = random.Next() % 2 == 0 ? 0.0 : -0.0;
  }
}

/// Some buckets, all from one seed.
Buckets RandomBuckets(SplitMix64& random) {
  std::vector<int> sizes(1 + At(static_cast<std::int64_t>(random.Next() % 20)));
  for (int& size : sizes) size = static_cast<int>(random.Next() % (random.Next() % 3 == 0 ? 81 : 20));
  ++sizes[0];  // there are points
  Buckets b(sizes);
  b.Deal(random);
  constexpr double kThicknesses[] = {0.0095, 0.004, 0.0001, 0.0125, 0};
  const std::uint64_t kinds = 1 + random.Next() % 4, firstKind = random.Next() % 5;
  for (double& thickness : b.thickness) thickness = kThicknesses[(firstKind + random.Next() % kinds) % 5];
  const std::uint64_t fixedShare = random.Next() % 3 == 0 ? 4 : 0;
  for (auto& fixed : b.fixed) fixed = fixedShare != 0 && random.Next() % fixedShare == 0 ? 1 : 0;
  constexpr double kSteps[] = {1, 2, 30, 1000};
  b.stepsPerFrame = kSteps[random.Next() % 4];
  constexpr double kBoxes[] = {0.02, 0.0612, 0.3, 5};
  const double box = kBoxes[random.Next() % 4];
  b.span = random.Next() % 3 == 0 ? kInfinity : box;
  for (std::size_t bucket = 0; bucket < sizes.size(); ++bucket) {
    const auto cluster = static_cast<Cluster>(random.Next() % static_cast<std::uint64_t>(Cluster::kCount));
    Place(b, bucket, cluster, box, random);
  }
  return b;
}

}  // namespace

TEST_CASE("points part as in the plain loop, to the last bit") {
  SplitMix64 random(42);
  std::int64_t total = 0;
  for (int round = 0; round < 6000; ++round) {
    CAPTURE(round);
    const Buckets start = RandomBuckets(random);
    Buckets plain = start;
    const std::int64_t contacts = plain.SeparatePlainly();
    total += contacts;
    for (const Kernels* kernels : RunnableKernels()) {
      CAPTURE(std::string(kernels->name));
      Buckets parted = start;
      REQUIRE(parted.Separate(*kernels) == contacts);
      REQUIRE(Difference(parted.x, plain.x, 0, plain.x.size, SameBits) == "");
    }
  }
  CHECK(total > 1000000);
}

TEST_CASE("a point among 1 to 80 others, all of them near") {
  SplitMix64 random(43);
  for (int count = 2; count <= 80; ++count) {
    for (const double span : {0.0612, kInfinity}) {
      for (const bool same : {false, true}) {
        Buckets start({count});
        start.Deal(random);
        start.span = span;
        for (double& thickness : start.thickness) thickness = same || random.Next() % 2 == 0 ? 0.0095 : 0.01;
        Place(start, 0, Cluster::Dense, 0.0612, random);
        Buckets plain = start;
        const std::int64_t contacts = plain.SeparatePlainly();
        for (const Kernels* kernels : RunnableKernels()) {
          CAPTURE(std::string(kernels->name));
          CAPTURE(count);
          CAPTURE(span);
          Buckets parted = start;
          REQUIRE(parted.Separate(*kernels) == contacts);
          REQUIRE(Difference(parted.x, plain.x, 0, count, SameBits) == "");
        }
      }
    }
  }
}

TEST_CASE("two points at the limit, and an ulp on either side of it, far from the first of their box") {
  SplitMix64 random(44);
  for (const double thickness : {0.0095, 1e-6, 0.3}) {
    for (const double span : {2.5, 100.0, 1e6, kInfinity}) {
      for (int round = 0; round < 300; ++round) {
        Buckets start({3});
        start.Deal(random);
        start.span = span;
        std::fill(start.thickness.begin(), start.thickness.end(), thickness);
        const double reach = std::min(span, 1e6) - 2;
        for (int axis = 0; axis < 3; ++axis) start.x(axis, 1) = reach * (0.5 + 0.5 * random.NextUnit());
        for (int axis = 0; axis < 3; ++axis) start.x(axis, 2) = start.x(axis, 1);
        double& x = start.x(static_cast<int>(random.Next() % 3), 2);
        x += 2 * thickness;
        if (round % 3 != 0) x = std::nextafter(x, round % 3 == 1 ? -1e9 : 1e9);
        Buckets plain = start;
        const std::int64_t contacts = plain.SeparatePlainly();
        for (const Kernels* kernels : RunnableKernels()) {
          CAPTURE(std::string(kernels->name));
          CAPTURE(thickness);
          CAPTURE(span);
          Buckets parted = start;
          REQUIRE(parted.Separate(*kernels) == contacts);
          REQUIRE(Difference(parted.x, plain.x, 0, 3, SameBits) == "");
        }
      }
    }
  }
}
