#pragma once
/// \file
/// A spatial map: points sorted by the key of their box, as a grid in two arrays. Rebuilt in linear
/// time without allocating.

#include <cstdint>
#include <span>
#include <vector>

namespace percale {

class BoxMap {
 public:
  /// Makes room for `points` points.
  void Reserve(int points);

  /// Groups the points 0..keys.size()-1 by equal key. Buckets stand in the order of their first
  /// point, the points of a bucket in ascending order. keys.size() must not exceed what was reserved.
  void Build(std::span<const std::uint64_t> keys);

  int BucketCount() const { return bucketCount_; }
  std::span<const std::int32_t> Bucket(int bucket) const {
    const auto b = static_cast<std::size_t>(bucket);
    return {members_.data() + first_[b], static_cast<std::size_t>(first_[b + 1] - first_[b])};
  }
  /// The same as arrays: all members, bucket after bucket, and per bucket the index of its first
  /// member, with one more at the end.
  std::span<const std::int32_t> Members() const { return members_; }
  std::span<const std::int32_t> First() const { return {first_.data(), static_cast<std::size_t>(bucketCount_) + 1}; }

 private:
  bool FindBuckets(std::span<const std::uint64_t> keys);

  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t build = 0;  // the build that filled it; others count as empty
    std::int32_t bucket = 0;
  };
  std::vector<Slot> table_;  // open addressing
  int tableBits_ = 0;        // 2^tableBits_ of its slots are in use; as few as serve, so that they stay in cache
  std::uint32_t build_ = 0;
  int bucketCount_ = 0;
  std::vector<std::int32_t> bucketOf_;  // per point
  std::vector<std::int32_t> first_;     // per bucket: index of its first member, and the end
  std::vector<std::int32_t> next_;      // per bucket: where its next member goes
  std::vector<std::int32_t> members_;
};

}  // namespace percale
