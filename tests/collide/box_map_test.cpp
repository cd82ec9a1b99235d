#include "collide/box_map.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "math/splitmix64.h"
#include "tests/sanitized.h"

using namespace percale;

namespace {

/// What is wrong with the map of these keys, or nothing: the buckets are a partition of the points,
/// members ascend, and two points share a bucket just when their keys are equal.
std::string Fault(const BoxMap& map, const std::vector<std::uint64_t>& keys) {
  std::vector<int> seen(keys.size(), 0);
  std::unordered_map<std::uint64_t, int> bucketOfKey;
  for (int b = 0; b < map.BucketCount(); ++b) {
    const auto members = map.Bucket(b);
    if (members.data() != map.Members() + map.First()[b]) return "two views of a bucket differ";
    if (static_cast<int>(members.size()) != map.Count()[b]) return "two sizes of a bucket differ";
    if (members.empty()) continue;
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m] < 0 || static_cast<std::size_t>(members[m]) >= keys.size()) return "a member that is no point";
      if (m > 0 && members[m] <= members[m - 1]) return "members that do not ascend";
      if (keys[static_cast<std::size_t>(members[m])] != keys[static_cast<std::size_t>(members[0])]) {
        return "different keys in one bucket";
      }
      ++seen[static_cast<std::size_t>(members[m])];
    }
    for (std::size_t m = members.size(); m % BoxMap::kPadding != 0; ++m) {
      if (members.data()[m] != members[0]) return "another member behind a bucket than its first";
    }
    if (!bucketOfKey.emplace(keys[static_cast<std::size_t>(members[0])], b).second) return "a key with two buckets";
  }
  for (const int count : seen) {
    if (count != 1) return "a point that is in " + std::to_string(count) + " buckets";
  }
  return "";
}

/// What `Build` promises beyond that: no bucket is empty, and they are in the order of their first points.
std::string BuildAndCheck(BoxMap& map, const std::vector<std::uint64_t>& keys) {
  map.Build(keys);
  std::int32_t lastFirst = -1;
  for (int b = 0; b < map.BucketCount(); ++b) {
    const auto members = map.Bucket(b);
    if (members.empty()) return "bucket " + std::to_string(b) + " is empty";
    if (members[0] <= lastFirst) return "buckets that are not in the order of their first point";
    lastFirst = members[0];
  }
  return Fault(map, keys);
}

/// A map that is updated, and the keys that it should have.
struct Moving {
  explicit Moving(std::vector<std::uint64_t> start) : keys(std::move(start)), named(keys.size(), 0) {
    map.Reserve(static_cast<int>(keys.size()));
    map.Build(keys);
  }

  /// For the next update. A point may get the key that it has.
  void Set(std::size_t point, std::uint64_t key) {
    keys[point] = key;
    if (named[point] == 0) changed.push_back(static_cast<std::int32_t>(point));
    named[point] = 1;
  }
  std::string Update() {
    map.Update(keys, changed);
    for (const std::int32_t point : changed) named[static_cast<std::size_t>(point)] = 0;
    changed.clear();
    return Fault(map, keys);
  }

  std::vector<std::uint64_t> keys;
  std::vector<char> named;
  std::vector<std::int32_t> changed;
  BoxMap map;
};

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

TEST_CASE("a build's buckets are in the order that follows from the keys alone") {
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

TEST_CASE("random updates, of few points and of many, give the partition of a fresh build") {
  SplitMix64 random(7);
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{9}, std::size_t{40}, std::size_t{700}}) {
    // Few keys: full buckets that outgrow their room. Many: new buckets all the time, and empty ones.
    for (const std::uint64_t range : {std::uint64_t{1}, std::uint64_t{3}, std::uint64_t{50}, ~std::uint64_t{0}}) {
      CAPTURE(count);
      CAPTURE(range);
      std::vector<std::uint64_t> start(count);
      for (auto& key : start) key = random.Next() % range;
      Moving moving(start);
      for (int update = 0; update < 1500; ++update) {
        CAPTURE(update);
        // Up to an eighth of the points mostly, beyond that now and then.
        const std::uint64_t most = random.Next() % 50 == 0 ? count + 1 : count / 8 + 2;
        for (std::uint64_t changes = random.Next() % most; changes > 0; --changes) {
          moving.Set(random.Next() % count, random.Next() % range);
        }
        REQUIRE(moving.Update() == "");
      }
    }
  }
}

TEST_CASE("a cloth that drifts through boxes, for thousands of updates") {
  // 40 x 40 points, three to a box; boxes are left behind for good, so that empty buckets pile up.
  constexpr std::size_t kSide = 40;
  const auto keyAt = [](double x, double y) {
    return static_cast<std::uint64_t>(x / 3) | static_cast<std::uint64_t>(y / 3) << 21;
  };
  for (const double speed : {0.003, 0.03, 0.3}) {
    CAPTURE(speed);
    SplitMix64 random(8);
    std::vector<double> x(kSide * kSide), y(x.size());
    std::vector<std::uint64_t> start(x.size());
    for (std::size_t p = 0; p < x.size(); ++p) {
      x[p] = 10 + static_cast<double>(p % kSide) + random.NextUnit();
      y[p] = 10 + static_cast<double>(p / kSide) + random.NextUnit();
      start[p] = keyAt(x[p], y[p]);
    }
    Moving moving(start);
    for (int update = 0; update < test::Fewer(2500); ++update) {
      CAPTURE(update);
      for (std::size_t p = 0; p < x.size(); ++p) {
        x[p] += speed * (1 + 0.5 * random.NextUnit());
        y[p] += speed * (random.NextUnit() - 0.45);
        if (keyAt(x[p], y[p]) != moving.keys[p]) moving.Set(p, keyAt(x[p], y[p]));
      }
      REQUIRE(moving.Update() == "");
    }
  }
}

TEST_CASE("points that gather in one bucket, scatter into one each, and gather again") {
  constexpr std::size_t kCount = 400;
  SplitMix64 random(9);
  std::vector<std::uint64_t> start(kCount);
  for (std::size_t p = 0; p < kCount; ++p) start[p] = p;
  Moving moving(start);
  std::vector<std::size_t> order(kCount);
  for (std::size_t p = 0; p < kCount; ++p) order[p] = p;
  for (std::uint64_t round = 1; round <= 12; ++round) {
    for (const bool gather : {true, false}) {
      CAPTURE(round);
      CAPTURE(gather);
      for (std::size_t i = kCount - 1; i > 0; --i) std::swap(order[i], order[random.Next() % (i + 1)]);
      const std::size_t share = 1 + random.Next() % (kCount / 8);
      for (std::size_t begin = 0; begin < kCount; begin += share) {
        for (std::size_t i = begin; i < std::min(begin + share, kCount); ++i) {
          moving.Set(order[i], gather ? round << 32 : (round << 32) + 1 + order[i]);
        }
        REQUIRE(moving.Update() == "");
      }
    }
  }
}

TEST_CASE("builds amid updates") {
  constexpr std::size_t kCount = 300;
  SplitMix64 random(10);
  Moving moving(std::vector<std::uint64_t>(kCount, 1));
  for (int update = 0; update < 3000; ++update) {
    CAPTURE(update);
    for (std::uint64_t changes = random.Next() % 12; changes > 0; --changes) {
      moving.Set(random.Next() % kCount, random.Next() % 1000);
    }
    REQUIRE(moving.Update() == "");
    if (random.Next() % 100 != 0) continue;
    for (auto& key : moving.keys) key = random.Next() % 200;
    REQUIRE(BuildAndCheck(moving.map, moving.keys) == "");
  }
}
