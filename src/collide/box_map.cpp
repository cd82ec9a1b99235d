#include "collide/box_map.h"

#include <algorithm>
#include <cassert>

#include "core/index.h"
#include "core/prefetch.h"

namespace percale {

namespace {

constexpr int kSmallestTable = 6;  // bits
constexpr int kAhead = 4;          // points that change their bucket: so early what they need is asked for
constexpr int kMostEmpty = 5;      // at most one bucket of that many is empty: readers stumble over them
// Room of a bucket: more than its members, so that few outgrow it; and the padding.
constexpr std::int32_t Room(std::int32_t members) {
  return (members + 1 + 2 * BoxMap::kPadding - 1) / BoxMap::kPadding * BoxMap::kPadding;
}
constexpr int kMostRoom = 16;  // no bucket has more room than this times its members ...
constexpr int kAllRoom = 18;   // ... and so there is room for 2 per point where outgrown buckets go

}  // namespace

void BoxMap::Reserve(int points) {
  const std::size_t count = Index(points);
  int bits = kSmallestTable;
  while ((std::size_t{1} << bits) < 4 * count) ++bits;
  table_.assign(std::size_t{1} << bits, {});
  tableBits_ = kSmallestTable;
  build_ = 0;
  bucketCount_ = emptyCount_ = 0;
  bucketOf_.resize(count);
  first_.resize(2 * count + 1);
  count_.resize(2 * count + 1);
  capacity_.resize(2 * count + 1);
  static_assert(Room(1) <= kMostRoom && Room(2) <= 2 * kMostRoom);
  members_.assign(kAllRoom * count, 0);
}

void BoxMap::Build(std::span<const std::uint64_t> keys) {
  assert(keys.size() <= bucketOf_.size());
  while (!FindBuckets(keys)) ++tableBits_;
  membersEnd_ = 0;
  for (std::size_t b = 0; b < Index(bucketCount_); ++b) {
    first_[b] = membersEnd_;
    capacity_[b] = Room(count_[b]) - kPadding;
    membersEnd_ += Room(count_[b]);
    count_[b] = 0;
  }
  for (std::size_t p = 0; p < keys.size(); ++p) {
    const std::size_t b = Index(bucketOf_[p]);
    members_[Index(first_[b] + count_[b]++)] = static_cast<std::int32_t>(p);
  }
  for (std::size_t b = 0; b < Index(bucketCount_); ++b) SetCount(b, count_[b]);
}

/// Sets a bucket's number of members, and pads them.
void BoxMap::SetCount(std::size_t bucket, std::int32_t count) {
  count_[bucket] = count;
  std::int32_t* const members = members_.data() + first_[bucket];
  std::fill_n(members + count, kPadding, members[0]);
}

/// Where a key goes, unless others are there.
std::size_t BoxMap::FirstSlot(std::uint64_t key) const {
  return Index(static_cast<std::int64_t>((key * 0x9e3779b97f4a7c15u) >> (64 - tableBits_)));
}

/// Where the key is, or the empty slot where it goes.
BoxMap::Slot& BoxMap::FindSlot(std::uint64_t key) {
  const std::size_t mask = (std::size_t{1} << tableBits_) - 1;
  std::size_t at = FirstSlot(key);
  while (table_[at].build == build_ && table_[at].key != key) at = (at + 1) & mask;
  return table_[at];
}

/// Fills bucketOf_, and count_ with the buckets' sizes. Returns false when the table is too small.
bool BoxMap::FindBuckets(std::span<const std::uint64_t> keys) {
  if (++build_ == 0) {  // the counter came round: old builds could be taken for new ones
    std::fill(table_.begin(), table_.end(), Slot{});
    build_ = 1;
  }
  const std::int32_t mostBuckets = std::int32_t{1} << (tableBits_ - 2);  // as many again may come by `Update`
  std::int32_t buckets = 0, bucket = -1;
  std::uint64_t lastKey = 0;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    const std::uint64_t key = keys[p];
    if (key != lastKey || bucket < 0) {  // neighbours in the grid mostly share their box
      lastKey = key;
      Slot& slot = FindSlot(key);
      if (slot.build != build_) {
        if (buckets == mostBuckets) return false;
        slot = {key, build_, buckets};
        count_[Index(buckets++)] = 0;
      }
      bucket = slot.bucket;
    }
    bucketOf_[p] = bucket;
    ++count_[Index(bucket)];
  }
  bucketCount_ = buckets;
  emptyCount_ = 0;
  return true;
}

void BoxMap::Update(std::span<const std::uint64_t> keys, std::span<const std::int32_t> changed) {
  if (changed.size() > keys.size() / 8 || emptyCount_ > bucketCount_ / kMostEmpty) {
    Build(keys);
    return;
  }
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const std::size_t point = Index(changed[i]);
    if (i + kAhead < changed.size()) {
      const std::size_t later = Index(changed[i + kAhead]);
      Prefetch(&members_[Index(first_[Index(bucketOf_[later])])]);
      Prefetch(&table_[FirstSlot(keys[later])]);
    }
    Remove(bucketOf_[point], changed[i]);
    if (!Insert(keys[point], changed[i])) {
      Build(keys);
      return;
    }
  }
}

void BoxMap::Remove(std::int32_t bucket, std::int32_t point) {
  const std::size_t b = Index(bucket);
  std::int32_t* const members = members_.data() + first_[b];
  // Those behind the point move up.
  std::int32_t at = count_[b] - 1;
  for (std::int32_t next = members[at]; next != point;) std::swap(members[--at], next);
  SetCount(b, count_[b] - 1);
  emptyCount_ += count_[b] == 0 ? 1 : 0;
}

/// Returns false when there is no room.
bool BoxMap::Insert(std::uint64_t key, std::int32_t point) {
  Slot& slot = FindSlot(key);
  if (slot.build != build_) {
    if (bucketCount_ == std::int32_t{1} << (tableBits_ - 1) || Index(bucketCount_) == first_.size()) return false;
    slot = {key, build_, bucketCount_++};
    first_[Index(slot.bucket)] = count_[Index(slot.bucket)] = capacity_[Index(slot.bucket)] = 0;
    ++emptyCount_;
  }
  const std::size_t b = Index(slot.bucket);
  if (count_[b] == 0) --emptyCount_;
  if (count_[b] == capacity_[b]) {
    const std::int32_t room = Room(2 * count_[b]);
    if (Index(membersEnd_ + room) > members_.size()) return false;
    std::copy_n(members_.data() + first_[b], count_[b], members_.data() + membersEnd_);
    first_[b] = membersEnd_;
    capacity_[b] = room - kPadding;
    membersEnd_ += room;
  }
  bucketOf_[Index(point)] = slot.bucket;
  // Those that are to stand behind the point move down.
  std::int32_t* const members = members_.data() + first_[b];
  std::int32_t at = count_[b];
  for (; at > 0 && members[at - 1] > point; --at) members[at] = members[at - 1];
  members[at] = point;
  SetCount(b, count_[b] + 1);
  return true;
}

}  // namespace percale
