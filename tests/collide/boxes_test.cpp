#include "collide/boxes.h"

#include <doctest/doctest.h>

#include <vector>

#include "math/splitmix64.h"

using namespace percale;

namespace {

constexpr Vec3 kUnitBoxes{1, 1, 1};

/// Points at random in a cube of that edge around the origin.
std::vector<Vec3> Cloud(int count, double edge) {
  SplitMix64 random(184);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.NextUnit(), y = random.NextUnit(), z = random.NextUnit();
    points.push_back(edge * (Vec3{x, y, z} - Vec3{0.5, 0.5, 0.5}));
  }
  return points;
}

}  // namespace

TEST_CASE("a box spans three spacings of the widest grid") {
  ClothSettings wide, fine;
  wide.width = 2;
  fine.numWidthPoints = fine.numHeightPoints = 100;
  const ClothSettings cloths[] = {fine, wide};
  const Vec3 size = BoxSize(cloths);
  CHECK(size.x == doctest::Approx(3 * 2.0 / 50));
  CHECK(size.y == doctest::Approx(3 * 1.0 / 50));
  CHECK(size.z == size.x);
}

TEST_CASE("points on either side of a border are in neighbouring boxes, below zero as well") {
  CHECK(BoxOf({0.5, 1.0, -0.5}, kUnitBoxes) == Box{0, 1, -1});
  CHECK(BoxOf({-1.0, 0.999, -1.001}, kUnitBoxes) == Box{-1, 0, -2});
}

TEST_CASE("the write-up's hash functions let boxes share a bucket") {
  CHECK(SharedBucket({3, -2, 5}, HashFunction::Linear) == 7 * 3 - 5 * 2 + 3 * 5);
  CHECK(SharedBucket({3, 0, 0}, HashFunction::Linear) == SharedBucket({0, 0, 7}, HashFunction::Linear));
  CHECK(SharedBucket({3, -2, 5}, HashFunction::Powers) == 729 + 16 + 25);
  CHECK(SharedBucket({1, 2, 3}, HashFunction::Powers) == SharedBucket({-1, -2, -3}, HashFunction::Powers));
}

TEST_CASE("pairs that lie at hand are counted as what they are") {
  // Two in one box; a third close to the second, across the border; a fourth far off, in a box that
  // shares the first one's bucket: 7 * 3 = 3 * 7.
  const std::vector<Vec3> points = {{3.5, 0.5, 0.5}, {3.9, 0.5, 0.5}, {4.1, 0.5, 0.5}, {0.5, 0.5, 7.5}};
  const PairCounts exact = CountPairs(points, kUnitBoxes, 0.3, HashFunction::Exact);
  CHECK(exact.compared == 1);
  CHECK(exact.fromOtherBoxes == 0);
  CHECK(exact.close == 1);
  CHECK(exact.missed == 1);
  const PairCounts linear = CountPairs(points, kUnitBoxes, 0.3, HashFunction::Linear);
  CHECK(linear.compared == 3);
  CHECK(linear.fromOtherBoxes == 2);
  CHECK(linear.missed == 1);
}

TEST_CASE("brute force misses nothing, exact has no false neighbours, sharing misses no more than exact") {
  const std::vector<Vec3> points = Cloud(300, 5);
  const auto count = [&](HashFunction hash) { return CountPairs(points, kUnitBoxes, 0.6, hash); };
  const PairCounts exact = count(HashFunction::Exact), brute = count(HashFunction::Brute);
  CHECK(brute.compared == 300 * 299 / 2);
  CHECK(brute.missed == 0);
  CHECK(exact.fromOtherBoxes == 0);
  CHECK(exact.missed > 0);
  for (const HashFunction hash : {HashFunction::Linear, HashFunction::Powers}) {
    const PairCounts shared = count(hash);
    CHECK(shared.close == exact.close);
    CHECK(shared.compared == exact.compared + shared.fromOtherBoxes);
    CHECK(shared.fromOtherBoxes > 0);
    CHECK(shared.missed <= exact.missed);
  }
}
