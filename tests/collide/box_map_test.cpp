#include "collide/box_map.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "math/splitmix64.h"

using namespace percale;

namespace {

/// What is wrong with the map of these keys, or nothing: the buckets are a partition of the points,
/// members ascend, and two points share a bucket just when their keys are equal.
std::string Fault(const BoxMap& map, const std::vector<std::uint64_t>& keys) {
  std::vector<int> seen(keys.size(), 0);
  std::unordered_map<std::uint64_t, int> bucketOfKey;
  const auto first = map.First();
  if (static_cast<int>(first.size()) != map.BucketCount() + 1) return "a wrong number of bucket ends";
  int before = 0;
  std::int32_t lastFirst = -1;
  for (int b = 0; b < map.BucketCount(); ++b) {
    const auto members = map.Bucket(b);
    if (members.empty()) return "bucket " + std::to_string(b) + " is empty";
    if (first[static_cast<std::size_t>(b)] != before) return "bucket " + std::to_string(b) + " is out of place";
    if (members.data() != map.Members().data() + before) return "two views of a bucket differ";
    if (members[0] <= lastFirst) return "buckets that are not in the order of their first point";
    lastFirst = members[0];
    before += static_cast<int>(members.size());
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m] < 0 || static_cast<std::size_t>(members[m]) >= keys.size()) return "a member that is no point";
      if (m > 0 && members[m] <= members[m - 1]) return "members that do not ascend";
      if (keys[static_cast<std::size_t>(members[m])] != keys[static_cast<std::size_t>(members[0])]) {
        return "different keys in one bucket";
      }
      ++seen[static_cast<std::size_t>(members[m])];
    }
    if (!bucketOfKey.emplace(keys[static_cast<std::size_t>(members[0])], b).second) return "a key with two buckets";
  }
  if (first.back() != static_cast<int>(keys.size())) return "a wrong number of points";
  for (const int count : seen) {
    if (count != 1) return "a point that is in " + std::to_string(count) + " buckets";
  }
  return "";
}

std::string BuildAndCheck(BoxMap& map, const std::vector<std::uint64_t>& keys) {
  map.Build(keys);
  return Fault(map, keys);
}

}  // namespace

TEST_CASE("no points, one point, two points") {
  BoxMap map;
  map.Reserve(2);
  CHECK(BuildAndCheck(map, {}) == "");
  CHECK(map.BucketCount() == 0);
  for (const std::uint64_t key : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{17}}) {
    CHECK(BuildAndCheck(map, {key}) == "");
    CHECK(map.BucketCount() == 1);
    CHECK(BuildAndCheck(map, {key, key}) == "");
    CHECK(map.BucketCount() == 1);
    CHECK(BuildAndCheck(map, {key, key + 1}) == "");
    CHECK(map.BucketCount() == 2);
  }
}

TEST_CASE("all keys equal, all distinct") {
  constexpr std::size_t kCount = 3000;
  BoxMap map;
  map.Reserve(kCount);
  std::vector<std::uint64_t> keys(kCount, 7);
  CHECK(BuildAndCheck(map, keys) == "");
  CHECK(map.BucketCount() == 1);
  // The same low bits, the same high bits, and a run: none may make a table lose a key.
  for (const std::uint64_t factor :
       {std::uint64_t{1}, std::uint64_t{1} << 21, std::uint64_t{1} << 42, std::uint64_t{1} << 50}) {
    for (std::size_t p = 0; p < kCount; ++p) keys[p] = p * factor;
    CHECK(BuildAndCheck(map, keys) == "");
    CHECK(map.BucketCount() == kCount);
  }
}

TEST_CASE("random keys, rebuilt many times with more and fewer points than before") {
  SplitMix64 random(5);
  constexpr int kMost = 700;
  BoxMap map;
  map.Reserve(kMost);
  for (int build = 0; build < 3000; ++build) {
    CAPTURE(build);
    const std::size_t count = random.Next() % (kMost + 1);
    const std::uint64_t range = std::uint64_t{1} << random.Next() % 64;
    std::vector<std::uint64_t> keys(count);
    for (std::size_t p = 0; p < count; ++p) {
      // Runs of equal keys, as in a grid, and stray ones.
      keys[p] = p > 0 && random.Next() % 3 == 0 ? keys[p - 1] : random.Next() % range;
    }
    REQUIRE(BuildAndCheck(map, keys) == "");
  }
}

TEST_CASE("buckets are in the order that follows from the keys alone") {
  // Whatever was built before: the same keys give the same buckets.
  SplitMix64 random(6);
  std::vector<std::uint64_t> keys(500);
  for (auto& key : keys) key = random.Next() % 100;
  BoxMap fresh, used;
  fresh.Reserve(500);
  used.Reserve(500);
  for (int build = 0; build < 20; ++build) {
    std::vector<std::uint64_t> other(500);
    for (auto& key : other) key = random.Next() % 400;
    used.Build(other);
  }
  fresh.Build(keys);
  used.Build(keys);
  REQUIRE(fresh.BucketCount() == used.BucketCount());
  for (int b = 0; b < fresh.BucketCount(); ++b) {
    const auto x = fresh.Bucket(b), y = used.Bucket(b);
    CHECK(std::vector<std::int32_t>(x.begin(), x.end()) == std::vector<std::int32_t>(y.begin(), y.end()));
  }
}

TEST_CASE("reserving again starts a new map") {
  BoxMap map;
  map.Reserve(4);
  CHECK(BuildAndCheck(map, {1, 2, 1, 3}) == "");
  map.Reserve(50);
  std::vector<std::uint64_t> keys(50);
  for (std::size_t p = 0; p < keys.size(); ++p) keys[p] = p % 5;
  CHECK(BuildAndCheck(map, keys) == "");
  CHECK(map.BucketCount() == 5);
}
