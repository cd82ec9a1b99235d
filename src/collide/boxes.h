#pragma once
/// \file
/// The boxes of the spatial map, the write-up's hash functions of them, and how well those find the
/// pairs of points that are close to one another.

#include <cstdint>
#include <span>

#include "percale/scene.h"
#include "percale/vec3.h"

namespace percale {

/// A box by its indices along the axes.
struct Box {
  std::int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const Box&, const Box&) = default;
};

/// The extent of a box [m]: three spacings of the grid, of the widest grid where there are several.
Vec3 BoxSize(std::span<const ClothSettings> cloths);
/// The box that holds a point; indices are kept where a 64-bit integer can hold them.
Box BoxOf(const Vec3& point, const Vec3& boxSize);

/// The bucket of a box by a hash function that lets boxes share buckets: Linear, Powers or Brute.
std::uint64_t SharedBucket(const Box& box, HashFunction hash);

/// Pairs of points, each counted once.
struct PairCounts {
  std::int64_t compared = 0;        ///< Share a bucket, so that their distance is computed.
  std::int64_t fromOtherBoxes = 0;  ///< False neighbours: share a bucket, but not a box.
  std::int64_t close = 0;           ///< Are no farther apart than the distance asked about.
  std::int64_t missed = 0;          ///< Are close, but share no bucket.
};

/// Counts the pairs of `positions` by comparing all with all. `distance` [m]: within it a pair is close.
PairCounts CountPairs(std::span<const Vec3> positions, const Vec3& boxSize, double distance, HashFunction hash);

}  // namespace percale
