// Forces and integration by themselves, against the rules of the classic simulator taken literally.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "math/splitmix64.h"
#include "tests/springs/kernel_arrays.h"

using namespace percale;
using namespace percale::springs;
using namespace percale::test;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kForeign = 12345.678;  // what belongs to another thread
constexpr double kBound = 1e6;

/// A sheet in some state, and all that a step needs.
struct Sheet {
  Sheet(int width, int height)
      : numWidth(width),
        numHeight(height),
        count(width * height),
        x(width, count),
        previous(width, count),
        extra(width, count),
        rest(count),
        scratch(At(IntegrateScratch(width) + 8)) {
    // Where a kernel reads what is not the sheet's, there may be another cloth.
    std::fill(x.store.begin(), x.store.end(), 0.125);
  }

  IntegrateArgs Args(Axes& moved, int rowBegin, int rowEnd) {
    IntegrateArgs args{};
    args.numWidth = numWidth;
    args.numHeight = numHeight;
    args.rowBegin = rowBegin;
    args.rowEnd = rowEnd;
    args.x = x.axis(0);
    args.previous = moved.axis(0);
    args.stride = x.stride;
    args.rest = rest[0];
    args.restStride = rest.stride;
    for (int axis = 0; axis < 3; ++axis) {
      args.weight[axis] = weight[axis];
      args.extraForce[axis] = windy ? extra.axis(axis) : nullptr;
    }
    for (int kind = 0; kind < kSpringKinds; ++kind) args.stiffness[kind] = stiffness[kind];
    args.keep = keep;
    args.forceToWay = forceToWay;
    args.bound = bound;
    args.scratch = scratch.data();
    return args;
  }

  int numWidth, numHeight, count;
  Axes x, previous, extra;
  RestLengths rest;
  std::vector<double> scratch;
  double stiffness[kSpringKinds] = {5000, 5000, 5000, 5000, 1000, 1000};
  double weight[3] = {0.25, -0.6, -0.01};
  double keep = 0.998, forceToWay = 2.3e-6, bound = kBound;
  bool windy = false;
};

/// The positions one step on: spring by spring in creation order, then Verlet point by point.
Axes ReferenceStep(const Sheet& s) {
  std::vector<double> force[3];
  for (int axis = 0; axis < 3; ++axis) {
    force[axis].assign(At(s.count), s.weight[axis]);
    for (int p = 0; s.windy && p < s.count; ++p) force[axis][At(p)] += s.extra(axis, p);
  }
  for (int p = 0; p < s.count; ++p) {
    for (int kind = 0; kind < kSpringKinds; ++kind) {
      if (!Creates(s.numWidth, p, kind) || s.stiffness[kind] == 0) continue;
      const std::int64_t q = p + Step(s.numWidth, kind);
      const double d[3] = {s.x(0, q) - s.x(0, p), s.x(1, q) - s.x(1, p), s.x(2, q) - s.x(2, p)};
      const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      if (length == 0) continue;
      const double factor = s.stiffness[kind] * (length - s.rest[kind][At(p)]) / length;
      for (int axis = 0; axis < 3; ++axis) {
        force[axis][At(p)] += d[axis] * factor;
        force[axis][At(q)] -= d[axis] * factor;
      }
    }
  }
  Axes next(s.numWidth, s.count);
  for (int axis = 0; axis < 3; ++axis) {
    for (int p = 0; p < s.count; ++p) {
      const double x = s.x(axis, p);
      next(axis, p) = x + s.keep * (x - s.previous(axis, p)) + s.forceToWay * force[axis][At(p)];
    }
  }
  return next;
}

bool AnyOutside(const Axes& x, std::int64_t begin, std::int64_t end, double bound) {
  for (int axis = 0; axis < 3; ++axis) {
    for (std::int64_t p = begin; p < end; ++p) {
      if (!(std::abs(x(axis, p)) <= bound)) return true;
    }
  }
  return false;
}

/// How the kernels' step of those rows differs from the reference and from each other, or nothing.
std::string StepFault(Sheet& s, const Axes& expected, int rowBegin, int rowEnd) {
  const std::int64_t begin = std::int64_t{rowBegin} * s.numWidth, end = std::int64_t{rowEnd} * s.numWidth;
  std::vector<Axes> results;
  for (const Kernels* kernels : RunnableKernels()) {
    const auto fault = [&](const std::string& what) {
      return std::string(kernels->name) + ", rows " + std::to_string(rowBegin) + " to " + std::to_string(rowEnd) +
             ": " + what;
    };
    Axes& moved = results.emplace_back(s.previous);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::int64_t p = -moved.front; p < moved.size + kGridPad; ++p) {
        if (p < begin || p >= end) moved(axis, p) = kForeign;
      }
    }
    const bool outside = kernels->integrate(s.Args(moved, rowBegin, rowEnd)) != 0;
    const std::string difference = Difference(moved, expected, begin, end, Same);
    if (difference != "") return fault(difference);
    const std::string between = Difference(moved, results[0], begin, end, SameBits);
    if (between != "") return fault("otherwise than " + std::string(RunnableKernels()[0]->name) + " " + between);
    if (outside != AnyOutside(expected, begin, end, s.bound)) return fault("a wrong report on bounds");
    for (int axis = 0; axis < 3; ++axis) {
      for (std::int64_t p = -moved.front; p < moved.size + kGridPad; ++p) {
        if ((p < begin || p >= end) && moved(axis, p) != kForeign) return fault("wrote outside of its rows");
      }
    }
  }
  return "";
}

enum class SheetShape { Cloth, Coincident, Short, Extreme };

/// Fills a sheet's state.
void Scatter(Sheet& s, SheetShape shape, SplitMix64& random) {
  constexpr double kSpacing = 0.02;
  // Squares underflow to zero, to denormal numbers, to less than what the quick root takes, and overflow.
  constexpr double kLengths[] = {0, 1e-200, 1e-160, 3e-155, 1e-140, -1e-200, -1e-160, 1, -0.0, 1e150, 1e160, -1e160};
  const std::size_t lengths = shape == SheetShape::Short ? 9 : std::size(kLengths);
  const auto noise = [&] { return 2 * random.NextUnit() - 1; };
  for (int p = 0; p < s.count; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      double& x = s.x(axis, p);
      switch (shape) {
        case SheetShape::Cloth:
          x = kSpacing * (axis == 0 ? p % s.numWidth : axis == 1 ? p / s.numWidth : 0) + 0.3 * kSpacing * noise();
          break;
        case SheetShape::Coincident:
          x = kSpacing * static_cast<double>(random.Next() % 2);
          break;
        default:
          x = kLengths[random.Next() % lengths];
      }
      s.previous(axis, p) = random.Next() % 8 == 0 ? 0 : x + 1e-4 * noise();
      s.extra(axis, p) = random.Next() % 8 == 0 ? -0.0 : noise();
    }
    for (int kind = 0; kind < kSpringKinds; ++kind) {
      if (Creates(s.numWidth, p, kind)) s.rest[kind][At(p)] = kSpacing * (1 + 0.5 * noise());
    }
  }
}

}  // namespace

TEST_CASE("a step of all rows, and of any of them, is the plain one to the last bit") {
  SplitMix64 random(20);
  std::vector<int> widths = {50, 64};
  for (int width = 2; width <= 20; ++width) widths.push_back(width);
  for (const int numWidth : widths) {
    for (int numHeight = 2; numHeight <= 9; ++numHeight) {
      for (const SheetShape shape :
           {SheetShape::Cloth, SheetShape::Coincident, SheetShape::Short, SheetShape::Extreme}) {
        Sheet s(numWidth, numHeight);
        Scatter(s, shape, random);
        s.windy = random.Next() % 2 == 0;
        if (shape != SheetShape::Extreme) {  // what overflows is not a number, enabled or not
          const std::uint64_t share = 1 + random.Next() % 6;
          for (double& k : s.stiffness) k = random.Next() % share == 0 ? 0 : k;
        }
        if (random.Next() % 3 == 0) s.weight[0] = 0, s.weight[1] = s.weight[2] = -0.0;
        CAPTURE(numWidth);
        CAPTURE(numHeight);
        CAPTURE(static_cast<int>(shape));
        CAPTURE(s.windy);
        const Axes expected = ReferenceStep(s);
        for (int rowBegin = 0; rowBegin < numHeight; ++rowBegin) {
          for (int rowEnd = rowBegin + 1; rowEnd <= numHeight; ++rowEnd) {
            REQUIRE(StepFault(s, expected, rowBegin, rowEnd) == "");
          }
        }
      }
    }
  }
}

TEST_CASE("one row alone is a sheet as well") {
  SplitMix64 random(21);
  for (int numWidth = 2; numWidth <= 40; ++numWidth) {
    CAPTURE(numWidth);
    Sheet s(numWidth, 1);
    Scatter(s, SheetShape::Cloth, random);
    REQUIRE(StepFault(s, ReferenceStep(s), 0, 1) == "");
  }
}

TEST_CASE("negative zeros are the same in all kernels") {
  for (int numWidth = 2; numWidth <= 18; ++numWidth) {
    Sheet s(numWidth, 4);
    std::fill(s.x.store.begin(), s.x.store.end(), -0.0);
    std::fill(std::begin(s.weight), std::end(s.weight), -0.0);
    CAPTURE(numWidth);
    REQUIRE(StepFault(s, ReferenceStep(s), 0, 4) == "");
  }
}

TEST_CASE("no mass, no damping, no springs: each by itself") {
  SplitMix64 random(22);
  for (const int numWidth : {3, 7, 8, 21}) {
    for (int which = 0; which < 4; ++which) {
      Sheet s(numWidth, 6);
      Scatter(s, SheetShape::Cloth, random);
      if (which == 0) s.forceToWay = 0;
      if (which == 1) s.keep = 1;
      if (which == 2) s.keep = 0;
      if (which == 3) std::fill(std::begin(s.stiffness), std::end(s.stiffness), 0.0);
      CAPTURE(numWidth);
      CAPTURE(which);
      REQUIRE(StepFault(s, ReferenceStep(s), 0, 6) == "");
    }
  }
}

TEST_CASE("a single point out of bounds is told by the thread that moves it, and by no other") {
  for (const int numWidth : {2, 3, 5, 8, 13}) {
    constexpr int kHeight = 5;
    Sheet s(numWidth, kHeight);
    std::fill(s.x.store.begin(), s.x.store.end(), 0.0);
    s.windy = true;
    s.forceToWay = 1;  // so that a point goes where the wind blows it
    std::fill(std::begin(s.weight), std::end(s.weight), 0.0);
    std::fill(std::begin(s.stiffness), std::end(s.stiffness), 0.0);
    const double values[] = {kInfinity,
                             -kInfinity,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::nextafter(kBound, kInfinity),
                             -std::nextafter(kBound, kInfinity),
                             kBound,
                             -kBound};
    for (int p = 0; p < s.count; ++p) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double value : values) {
          CAPTURE(numWidth);
          CAPTURE(p);
          CAPTURE(axis);
          CAPTURE(value);
          s.extra(axis, p) = value;
          const Axes expected = ReferenceStep(s);
          for (int row = 0; row < kHeight; ++row) REQUIRE(StepFault(s, expected, row, row + 1) == "");
          REQUIRE(StepFault(s, expected, 0, kHeight) == "");
          REQUIRE(AnyOutside(expected, 0, s.count, kBound) == !(std::abs(value) <= kBound));
          s.extra(axis, p) = 0;
        }
      }
    }
  }
}

namespace {

/// Springs of one kind whose squared lengths are given numbers, and whose rest lengths are the roots: all
/// forces are zero just when a kernel's roots are those of std::sqrt.
class RootProbe {
 public:
  explicit RootProbe(int kind) : kind_(kind), sheet_(kWidth, 3) {
    sheet_.keep = 0;
    sheet_.forceToWay = 1;
    sheet_.bound = kInfinity;
    std::fill(std::begin(sheet_.weight), std::end(sheet_.weight), 0.0);
    std::fill(std::begin(sheet_.stiffness), std::end(sheet_.stiffness), 1.0);
    // The lengths beside those of interest must not be out of the range of the quick root.
    for (int p = -sheet_.x.front; p < sheet_.count + kGridPad; ++p) {
      sheet_.x(0, p) = 1000 + p;
      sheet_.x(1, p) = 3;
    }
    for (int i = 0; i < kWidth; ++i) {
      const int p = Row() * kWidth + i;
      // Along a row creators and other ends take turns.
      const bool creates = kind == 0 ? i % 2 == 1 : kind == 4 ? i % 4 >= 2 : Creates(kWidth, p, kind);
      if (creates) creators_.push_back(p);
    }
  }

  /// The first of the numbers whose root is wrong, or nothing.
  std::string Fault(const Kernels& kernels, const std::vector<double>& squares) {
    for (std::size_t begin = 0; begin < squares.size(); begin += creators_.size()) {
      for (std::size_t c = 0; c < creators_.size(); ++c) {
        if (!Place(creators_[c], squares[std::min(begin + c, squares.size() - 1)])) return "a length that is not met";
      }
      Axes next = sheet_.x;
      kernels.integrate(sheet_.Args(next, Row(), Row() + 1));
      for (std::size_t c = 0; c < creators_.size(); ++c) {
        if (next(0, creators_[c]) == 0) continue;
        char text[64];
        std::snprintf(text, sizeof text, "%s: the root of %a", kernels.name,
                      squares[std::min(begin + c, squares.size() - 1)]);
        return text;
      }
    }
    return "";
  }

 private:
  static constexpr int kWidth = 512;

  int Row() const { return kind_ == 5 ? 2 : 1; }

  /// A spring from (0, 0, z) to (dx, dy, z), where dx^2 + dy^2 rounds to the square.
  bool Place(int creator, double square) {
    const double dx = std::sqrt(square) * (1 - 0x1p-30);
    const double dy = std::sqrt(square - dx * dx);
    const std::int64_t other = creator + Step(kWidth, kind_);
    const double z = 1 + creator % 16;
    sheet_.x(0, creator) = sheet_.x(1, creator) = 0;
    sheet_.x(0, other) = dx;
    sheet_.x(1, other) = dy;
    sheet_.x(2, creator) = sheet_.x(2, other) = z;
    sheet_.rest[kind_][At(creator)] = std::sqrt(square);
    return dx * dx + dy * dy + 0.0 * 0.0 == square;
  }

  int kind_;
  Sheet sheet_;
  std::vector<int> creators_;
};

std::string RootFault(const std::vector<double>& squares) {
  for (const Kernels* kernels : RunnableKernels()) {
    for (int kind = 0; kind < kSpringKinds; ++kind) {
      const std::string fault = RootProbe(kind).Fault(*kernels, squares);
      if (fault != "") return fault + ", kind " + std::to_string(kind);
    }
  }
  return "";
}

/// Doubles s whose roots are nearest to a midpoint m between two doubles: m^2 - r = 2^54 s for an odd m of
/// 54 bits and a small r. Hensel lifting finds the m.
/// By the errors of Goldschmidt's iteration only the smallest r are in danger; of several million starts within
/// 2^-14 of the inverse root a few in 100,000 went wrong, all of them with r = 1, that is with s = 1 + 2^-52 times
/// a power of 4. Which starts there are depends on the processor.
std::vector<double> HardSquares() {
  constexpr std::int64_t kHalf = std::int64_t{1} << 27, kTop = std::int64_t{1} << 53;
  std::vector<double> squares;
  for (std::int64_t r = -1023; r < 1024; r += 8) {  // the square of an odd number is 1 modulo 8
    std::uint64_t root = 1;                         // of r, modulo 2^bits
    for (int bits = 4; bits <= 55; ++bits) {
      const std::uint64_t wrong = root * root - static_cast<std::uint64_t>(r);
      if ((wrong & ((std::uint64_t{1} << bits) - 1)) != 0) root += std::uint64_t{1} << (bits - 2);
    }
    for (const std::uint64_t either : {root, ~root + 1}) {
      const std::int64_t m = static_cast<std::int64_t>(either & static_cast<std::uint64_t>(kTop - 1)) | kTop;
      const std::int64_t high = m / kHalf, low = m % kHalf;
      const std::int64_t middle = 2 * high * low + (low * low - r) / kHalf;
      const std::int64_t s = high * high + middle / kHalf;  // both divisions are exact
      if (s >= kTop && s % 2 != 0) continue;                // not a double
      squares.push_back(static_cast<double>(s));
    }
  }
  return squares;
}

}  // namespace

TEST_CASE("roots are rounded correctly: the squares whose roots are nearest to midpoints") {
  const std::vector<double> hard = HardSquares();
  CHECK(hard.size() > 300);
  // One order of magnitude at a time: where the smallest and the greatest are, roots may be taken in another way.
  for (const int exponent : {-1030, -952, -860, -100, -60, -52, 0, 400, 820, 960}) {
    CAPTURE(exponent);
    std::vector<double> squares;
    for (const double square : hard) squares.push_back(std::ldexp(square, exponent));
    CHECK(RootFault(squares) == "");
  }
}

TEST_CASE("roots are rounded correctly: powers of two, whole squares and their neighbours") {
  std::vector<double> squares;
  const auto add = [&](double square) {
    squares.push_back(square);
    for (const double way : {0.0, kInfinity}) {
      double neighbour = square;
      for (int i = 0; i < 3; ++i) squares.push_back(neighbour = std::nextafter(neighbour, way));
    }
  };
  for (int exponent = -899; exponent < 899; ++exponent) add(std::ldexp(1.0, exponent));
  for (int root = 1; root < 3000; ++root) add(static_cast<double>(root) * root);
  CHECK(RootFault(squares) == "");
}

TEST_CASE("roots are rounded correctly: ten million random numbers") {
  SplitMix64 random(23);
  std::vector<double> squares(50000);
  for (int round = 0; round < 200; ++round) {
    const int span = round % 2 == 0 ? 40 : 1780;  // of the exponents
    for (double& square : squares) {
      const int exponent = static_cast<int>(random.Next() % static_cast<std::uint64_t>(span)) - span / 2;
      square = std::ldexp(1 + random.NextUnit(), exponent);
    }
    // The first three kinds are those that may take quick roots.
    REQUIRE(RootProbe(round % 3).Fault(BestKernels(), squares) == "");
  }
  squares.resize(10000);
  CHECK(RootFault(squares) == "");
}
