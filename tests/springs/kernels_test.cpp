// The strain limit and its helpers by themselves, against plain loops over all springs.

#include "springs/kernels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "math/splitmix64.h"
#include "tests/springs/kernel_arrays.h"

using namespace percale;
using namespace percale::springs;
using namespace percale::test;

namespace {

constexpr double kLimit = 1.1;
constexpr double kNear = 0.99 * kLimit;  // a spring longer than that, times its rest length, is marked

/// A grid of the spacing 1 at rest, its corners a little off so that no two springs are equally long.
struct Sheet {
  Sheet(int width, int height, SplitMix64& random)
      : numWidth(width), numHeight(height), count(width * height), x(width, count), rest(count) {
    fixed.assign(At(count), 0);
    kinds.assign(At(count + MarkPadding(numWidth)), 0);
    nearSquared.assign(At(kSpringKinds * NearStride()), std::numeric_limits<float>::infinity());
    for (int p = 0; p < count; ++p) {
      x(0, p) = p % width + 0.01 * random.NextUnit();
      x(1, p) = p / width + 0.01 * random.NextUnit();
      x(2, p) = 0.01 * random.NextUnit();
    }
    shortest = std::numeric_limits<double>::infinity();
    for (int p = 0; p < count; ++p) {
      for (int kind = 0; kind < kSpringKinds; ++kind) {
        if (!Creates(width, p, kind)) continue;
        kinds[At(p)] = static_cast<std::uint8_t>(kinds[At(p)] | 1u << kind);
        rest[kind][At(p)] = std::sqrt(Squared(p, kind));
        float& near = nearSquared[At(kind * NearStride() + p % width)];
        near = std::min(near, static_cast<float>(std::pow(kNear * rest[kind][At(p)], 2)));
        shortest = std::min(shortest, rest[kind][At(p)]);
      }
    }
  }

  std::int64_t NearStride() const { return numWidth + kGridPad; }

  /// Of the length of a spring.
  double Squared(int p, int kind) const {
    const std::int64_t q = p + Step(numWidth, kind);
    const double dx = x(0, q) - x(0, p), dy = x(1, q) - x(1, p), dz = x(2, q) - x(2, p);
    return dx * dx + dy * dy + dz * dz;
  }

  std::int64_t Mark(const Kernels& kernels, int rowBegin, int rowEnd, std::vector<std::uint8_t>& marks) const {
    LongSpringsArgs args{};
    args.numWidth = numWidth;
    args.rowBegin = rowBegin;
    args.rowEnd = rowEnd;
    for (int axis = 0; axis < 3; ++axis) {
      args.x[axis] = x.axis(axis);
      args.origin[axis] = x(axis, 0);
    }
    args.farthest = farthest;
    args.nearSquared = nearSquared.data();
    args.nearStride = NearStride();
    std::vector<float> scratch(At(MarkScratch(numWidth)));
    args.scratch = scratch.data();
    args.nearKinds = marks.data();
    return kernels.markLongSprings(args);
  }

  std::int64_t Limit(const Kernels& kernels) {
    std::vector<std::uint8_t> marks(At(count + MarkPadding(numWidth)), 0);
    const std::int64_t found = Mark(kernels, 0, numHeight, marks);
    if (found == 0) return 0;
    if ((found & kSomeAreFarAway) != 0) std::copy(kinds.begin(), kinds.end(), marks.begin());
    std::vector<float> moved(At(count), 0);
    StrainArgs args{};
    args.numWidth = numWidth;
    args.pointCount = count;
    for (int axis = 0; axis < 3; ++axis) args.x[axis] = x.axis(axis);
    args.fixed = fixed.data();
    for (int kind = 0; kind < kSpringKinds; ++kind) args.rest[kind] = rest[kind];
    args.limit = kLimit;
    args.kinds = kinds.data();
    args.marks = marks.data();
    args.moved = moved.data();
    args.budget = static_cast<float>(0.49 * (kLimit - kNear) * shortest);
    return kernels.limitStrain(args);
  }

  /// Provot's sweep taken literally. Returns the number of springs shortened.
  std::int64_t LimitPlainly() {
    std::int64_t limited = 0;
    for (int p = 0; p < count; ++p) {
      for (int kind = 0; kind < kSpringKinds; ++kind) {
        if (!Creates(numWidth, p, kind)) continue;
        const std::int64_t q = p + Step(numWidth, kind);
        const double length = std::sqrt(Squared(p, kind)), limit = kLimit * rest[kind][At(p)];
        const bool fixedP = fixed[At(p)] != 0, fixedQ = fixed[At(q)] != 0;
        if (length <= limit || (fixedP && fixedQ)) continue;
        ++limited;
        const double factor = (length - limit) / length;
        for (int axis = 0; axis < 3; ++axis) {
          const double excess = (x(axis, q) - x(axis, p)) * factor;
          if (!fixedP) x(axis, p) += fixedQ ? excess : 0.5 * excess;
          if (!fixedQ) x(axis, q) -= fixedP ? excess : 0.5 * excess;
        }
      }
    }
    return limited;
  }

  int numWidth, numHeight, count;
  Axes x;
  RestLengths rest;
  float farthest = 1000;           // from the first point, along each axis
  std::vector<float> nearSquared;  // per kind and column
  std::vector<std::uint8_t> fixed, kinds;
  double shortest;
};

constexpr int kStretches = 7;
/// Stretches a sheet: evenly or at random, from below the limit to far beyond it.
void StretchSheet(Sheet& s, int how, SplitMix64& random) {
  const auto noise = [&] { return 2 * random.NextUnit() - 1; };
  for (int p = 0; p < s.count; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      double& x = s.x(axis, p);
      switch (how) {
        case 0:  // a few are near the limit
          x += 0.04 * noise();
          break;
        case 1:  // all are just below it
          x = 1.095 * x + 0.004 * noise();
          break;
        case 2:  // a few are long, and what they move makes others long
          x = 1.085 * x + (random.Next() % 20 == 0 ? 0.3 * noise() : 0);
          break;
        case 3:
          x += noise();
          break;
        case 4:
          x += 100 * noise();
          break;
        case 5:  // a hair below the mark, so that whatever is moved beyond the budget makes a spring long
          x = (kNear - 1e-6) * x + (random.Next() % 30 == 0 ? 0.06 * noise() : 0);
          break;
        default:  // one point was torn away
          if (p == s.count / 2) x += 30 * noise();
      }
    }
  }
}

}  // namespace

TEST_CASE("rows are marked by themselves: what another thread owns is not touched") {
  constexpr std::uint8_t kForeign = 0xc0;  // no kind has these bits
  SplitMix64 random(30);
  for (const Kernels* kernels : RunnableKernels()) {
    for (const int numWidth : {2, 3, 4, 5, 7, 8, 9, 17}) {
      constexpr int kHeight = 9;
      Sheet s(numWidth, kHeight, random);
      StretchSheet(s, numWidth % 2 == 0 ? 3 : 2, random);
      for (int rowBegin = 0; rowBegin < kHeight; ++rowBegin) {
        for (int rowEnd = rowBegin + 1; rowEnd <= kHeight; ++rowEnd) {
          CAPTURE(std::string(kernels->name));
          CAPTURE(numWidth);
          CAPTURE(rowBegin);
          CAPTURE(rowEnd);
          std::vector<std::uint8_t> marks(At(s.count + kGridPad), kForeign);
          const std::int64_t found = s.Mark(*kernels, rowBegin, rowEnd, marks);
          bool expected = false;
          for (int p = 0; p < s.count + kGridPad; ++p) {
            if (p < rowBegin * numWidth || p >= rowEnd * numWidth) {
              REQUIRE(marks[At(p)] == kForeign);
              continue;
            }
            REQUIRE(marks[At(p)] < 1u << kSpringKinds);
            for (int kind = 0; kind < kSpringKinds; ++kind) {
              const bool mark = (marks[At(p)] >> kind & 1) != 0;
              REQUIRE((!mark || Creates(numWidth, p, kind)));
              if (!Creates(numWidth, p, kind)) continue;
              // In float, what is as long as that may be told or not.
              const double ratio = s.Squared(p, kind) / s.nearSquared[At(kind * s.NearStride() + p % numWidth)];
              if (std::abs(ratio - 1) > 1e-4) REQUIRE(mark == (ratio > 1));
              expected = expected || mark;
            }
          }
          REQUIRE(((found & kSomeAreNear) != 0) == expected);
          REQUIRE((found & kSomeAreFarAway) == 0);
        }
      }
    }
  }
}

TEST_CASE("points too far away to be measured in float are told, and those of others are not") {
  SplitMix64 random(32);
  constexpr int kHeight = 4;
  for (const Kernels* kernels : RunnableKernels()) {
    for (const int numWidth : {2, 5, 8, 9, 17}) {
      Sheet s(numWidth, kHeight, random);
      s.farthest = static_cast<float>(numWidth + kHeight);
      for (int p = 0; p < s.count + kGridPad; ++p) {
        for (int axis = 0; axis < 3; ++axis) {
          for (const double way : {-1.0, 1.0}) {
            CAPTURE(std::string(kernels->name));
            CAPTURE(numWidth);
            CAPTURE(p);
            Sheet moved = s;
            moved.x(axis, p) += way * 3 * (numWidth + kHeight);
            std::vector<std::uint8_t> marks(At(s.count + kGridPad), 0);
            const std::int64_t found = moved.Mark(*kernels, 0, kHeight, marks);
            // What is far from the first is so from all others when that moves.
            REQUIRE(((found & kSomeAreFarAway) != 0) == (p < s.count));
          }
        }
      }
    }
  }
}

TEST_CASE("the strain limit is the plain sweep over all springs, whatever it skips") {
  SplitMix64 random(31);
  for (const int numWidth : {2, 3, 4, 5, 8, 13, 50}) {
    for (const int numHeight : {2, 3, 7, 30}) {
      for (int how = 0; how < kStretches; ++how) {
        for (const std::uint64_t fixedShare : {0, 2, 10}) {
          CAPTURE(numWidth);
          CAPTURE(numHeight);
          CAPTURE(how);
          CAPTURE(fixedShare);
          Sheet start(numWidth, numHeight, random);
          StretchSheet(start, how, random);
          for (auto& fixed : start.fixed) fixed = fixedShare != 0 && random.Next() % fixedShare == 0 ? 1 : 0;
          for (const Kernels* kernels : RunnableKernels()) {
            CAPTURE(std::string(kernels->name));
            Sheet plain = start, swept = start;
            for (int sweep = 0; sweep < 3; ++sweep) {
              CAPTURE(sweep);
              const std::int64_t limited = plain.LimitPlainly();
              REQUIRE(swept.Limit(*kernels) == limited);
              REQUIRE(Difference(swept.x, plain.x, 0, plain.count, Same) == "");
              if (sweep == 0 && how >= 3 && how < 5 && fixedShare == 0) REQUIRE(limited > 0);
            }
          }
        }
      }
    }
  }
}

TEST_CASE("a sheet whose points are all fixed is not limited") {
  SplitMix64 random(32);
  Sheet s(9, 9, random);
  StretchSheet(s, 3, random);
  std::fill(s.fixed.begin(), s.fixed.end(), 1);
  const Axes before = s.x;
  for (const Kernels* kernels : RunnableKernels()) {
    CHECK(s.Limit(*kernels) == 0);
    CHECK(Difference(s.x, before, 0, s.count, SameBits) == "");
  }
}

TEST_CASE("the greatest stretch is that of a plain loop, and the first of its points") {
  SplitMix64 random(33);
  for (const int numWidth : {2, 3, 4, 5, 7, 8, 9, 16, 50}) {
    for (const int numHeight : {1, 2, 3, 10}) {
      for (int how = 0; how <= kStretches; ++how) {
        Sheet s(numWidth, numHeight, random);
        if (how < kStretches) {
          StretchSheet(s, how, random);
        } else {  // all in one place: nothing is stretched
          std::fill(s.x.store.begin(), s.x.store.end(), 3.5);
        }
        double greatest = 0;
        int point = 0;
        for (int p = 0; p < s.count; ++p) {
          for (int kind = 0; kind < kSpringKinds; ++kind) {
            if (!Creates(numWidth, p, kind)) continue;
            const double ratio = s.Squared(p, kind) / (s.rest[kind][At(p)] * s.rest[kind][At(p)]);
            if (ratio > greatest) greatest = ratio, point = p;
          }
        }
        for (const Kernels* kernels : RunnableKernels()) {
          CAPTURE(std::string(kernels->name));
          CAPTURE(numWidth);
          CAPTURE(numHeight);
          CAPTURE(how);
          GreatestStretchArgs args{};
          args.numWidth = numWidth;
          args.pointCount = s.count;
          for (int axis = 0; axis < 3; ++axis) args.x[axis] = s.x.axis(axis);
          for (int kind = 0; kind < kSpringKinds; ++kind) args.rest[kind] = s.rest[kind];
          const GreatestStretchResult found = kernels->greatestStretch(args);
          REQUIRE(found.squaredRatio == greatest);
          REQUIRE(found.point == point);

          ElasticEnergyArgs energyArgs{};
          energyArgs.numWidth = numWidth;
          energyArgs.pointCount = s.count;
          double energy = 0;
          for (int kind = 0; kind < kSpringKinds; ++kind) {
            energyArgs.rest[kind] = s.rest[kind];
            energyArgs.stiffness[kind] = kind == 3 ? 0 : 100.0 + kind;
            for (int p = 0; p < s.count; ++p) {
              if (!Creates(numWidth, p, kind)) continue;
              const double longer = std::sqrt(s.Squared(p, kind)) - s.rest[kind][At(p)];
              energy += 0.5 * energyArgs.stiffness[kind] * longer * longer;
            }
          }
          for (int axis = 0; axis < 3; ++axis) energyArgs.x[axis] = s.x.axis(axis);
          CHECK(kernels->elasticEnergy(energyArgs) == doctest::Approx(energy).epsilon(1e-12));
          CHECK(kernels->elasticEnergy(energyArgs) == BaselineKernels().elasticEnergy(energyArgs));
        }
      }
    }
  }
}
