#include "percale/vec3.h"

#include <doctest/doctest.h>

#include <limits>

using namespace percale;

TEST_CASE("products of vectors") {
  const Vec3 a{1, -2, 3}, b{4, 5, -6};
  CHECK(Dot(a, b) == -24);
  CHECK(Cross(a, b) == Vec3{-3, 18, 13});
  CHECK(Dot(Cross(a, b), a) == 0);
  CHECK(Dot(Cross(a, b), b) == 0);
  CHECK(Cross(a, b) == -Cross(b, a));
  CHECK(Cross({1, 0, 0}, {0, 1, 0}) == Vec3{0, 0, 1});
}

TEST_CASE("sums, lengths and directions") {
  Vec3 a{1, 2, 3};
  a += {1, 1, 1};
  a -= {0, 1, 2};
  a *= 2;
  CHECK(a == Vec3{4, 4, 4});
  CHECK(2 * Vec3{1, 2, 3} - Vec3{2, 4, 6} / 2 == Vec3{1, 2, 3});
  CHECK(Length({2, -3, 6}) == 7);
  CHECK(UnitOr({0, 0, -5}, {0, 1, 0}) == Vec3{0, 0, -1});
  CHECK(UnitOr({0, 0, 0}, {0, 1, 0}) == Vec3{0, 1, 0});
}

TEST_CASE("a vector is finite where all of it is") {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(IsFinite({1e308, -1e308, 0}));
  CHECK_FALSE(IsFinite({infinity, 0, 0}));
  CHECK_FALSE(IsFinite({0, -infinity, 0}));
  CHECK_FALSE(IsFinite({0, 0, nan}));
}
