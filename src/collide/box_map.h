#pragma once
/// \file
/// A spatial map: points grouped by the key of their box, as a grid in a few arrays. Points that change
/// their box move from bucket to bucket; nothing allocates after `Reserve`.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace percale {

class BoxMap {
 public:
  /// Makes room for `points` points.
  void Reserve(int points);

  /// Groups the points 0..keys.size()-1 by equal key. The points of a bucket ascend. keys.size() must
  /// not exceed what was reserved.
  void Build(std::span<const std::uint64_t> keys);
  /// The same where only the keys of the points `changed` differ from those of the last `Build` or
  /// `Update`, each of them named once.
  void Update(std::span<const std::uint64_t> keys, std::span<const std::int32_t> changed);

  /// Some of the buckets may be empty.
  int BucketCount() const { return bucketCount_; }
  std::span<const std::int32_t> Bucket(int bucket) const {
    const auto b = static_cast<std::size_t>(bucket);
    return {members_.data() + first_[b], static_cast<std::size_t>(count_[b])};
  }
  /// The same as arrays: per bucket the index of its first member, and how many there are. Behind the
  /// last one its first stands again, kPadding times.
  static constexpr int kPadding = 8;
  const std::int32_t* Members() const { return members_.data(); }
  const std::int32_t* First() const { return first_.data(); }
  const std::int32_t* Count() const { return count_.data(); }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t build = 0;  // the build that filled it; others count as empty
    std::int32_t bucket = 0;
  };

  bool FindBuckets(std::span<const std::uint64_t> keys);
  std::size_t FirstSlot(std::uint64_t key) const;
  Slot& FindSlot(std::uint64_t key);
  void Remove(std::int32_t bucket, std::int32_t point);
  bool Insert(std::uint64_t key, std::int32_t point);
  void SetCount(std::size_t bucket, std::int32_t count);

  std::vector<Slot> table_;  // open addressing
  int tableBits_ = 0;        // 2^tableBits_ of its slots are in use; as few as serve, so that they stay in cache
  std::uint32_t build_ = 0;
  int bucketCount_ = 0;
  int emptyCount_ = 0;                  // of the buckets
  std::vector<std::int32_t> bucketOf_;  // per point
  std::vector<std::int32_t> first_;     // per bucket: index of its first member
  std::vector<std::int32_t> count_;     // per bucket: its members
  std::vector<std::int32_t> capacity_;  // per bucket: room for members
  std::vector<std::int32_t> members_;
  std::int32_t membersEnd_ = 0;  // from here on there is room for buckets that outgrow theirs
};

}  // namespace percale
