#include "math/splitmix64.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace percale;

TEST_CASE("splitmix64 gives the published numbers") {
  SplitMix64 random(1234567);
  CHECK(random.Next() == 6457827717110365317u);
  CHECK(random.Next() == 3203168211198807973u);
  CHECK(random.Next() == 9817491932198370423u);
  CHECK(random.Next() == 4593380528125082431u);
  CHECK(random.Next() == 16408922859458223821u);
}

TEST_CASE("unit numbers are the upper 53 bits, in [0, 1), spread evenly") {
  SplitMix64 bits(99), units(99);
  double sum = 0, squares = 0, lowest = 1, highest = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double u = units.NextUnit();
    REQUIRE(u == std::ldexp(static_cast<double>(bits.Next() >> 11), -53));
    sum += u;
    squares += u * u;
    lowest = std::min(lowest, u);
    highest = std::max(highest, u);
  }
  CHECK(lowest >= 0);
  CHECK(highest < 1);
  // Five standard deviations of the means.
  CHECK(std::abs(sum / kCount - 0.5) < 5 * std::sqrt(1.0 / 12 / kCount));
  CHECK(std::abs(squares / kCount - 1.0 / 3) < 5 * std::sqrt(4.0 / 45 / kCount));
}

TEST_CASE("equal seeds give equal numbers, other seeds others") {
  SplitMix64 a(184), b(184), c(185);
  int same = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto next = a.Next();
    REQUIRE(next == b.Next());
    same += next == c.Next();
  }
  CHECK(same == 0);
}
