#include "collide/box_map.h"

#include <algorithm>
#include <cassert>

namespace percale {

namespace {
constexpr int kSmallestTable = 6;  // bits
}

void BoxMap::Reserve(int points) {
  const auto count = static_cast<std::size_t>(points);
  int bits = kSmallestTable;
  while ((std::size_t{1} << bits) < 2 * count) ++bits;  // at most half full
  table_.assign(std::size_t{1} << bits, {});
  tableBits_ = kSmallestTable;
  build_ = 0;
  bucketCount_ = 0;
  bucketOf_.resize(count);
  first_.assign(count + 1, 0);
  next_.resize(count);
  members_.resize(count);
}

void BoxMap::Build(std::span<const std::uint64_t> keys) {
  assert(keys.size() <= members_.size());
  while (!FindBuckets(keys)) ++tableBits_;
  std::int32_t before = 0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(bucketCount_); ++b) {
    first_[b] = before;
    before += next_[b];
    next_[b] = first_[b];
  }
  first_[static_cast<std::size_t>(bucketCount_)] = before;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    members_[static_cast<std::size_t>(next_[static_cast<std::size_t>(bucketOf_[p])]++)] = static_cast<std::int32_t>(p);
  }
}

/// Fills bucketOf_, and next_ with the buckets' sizes. Returns false when the table is too small.
bool BoxMap::FindBuckets(std::span<const std::uint64_t> keys) {
  if (++build_ == 0) {  // the counter came round: old builds could be taken for new ones
    std::fill(table_.begin(), table_.end(), Slot{});
    build_ = 1;
  }
  const std::size_t mask = (std::size_t{1} << tableBits_) - 1;
  const std::int32_t mostBuckets = std::int32_t{1} << (tableBits_ - 1);
  const int shift = 64 - tableBits_;
  std::int32_t buckets = 0, bucket = -1;
  std::uint64_t lastKey = 0;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    const std::uint64_t key = keys[p];
    if (key != lastKey || bucket < 0) {  // neighbours in the grid mostly share their box
      lastKey = key;
      auto at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> shift);
      while (table_[at].build == build_ && table_[at].key != key) at = (at + 1) & mask;
      if (table_[at].build != build_) {
        if (buckets == mostBuckets) return false;
        table_[at] = {key, build_, buckets};
        next_[static_cast<std::size_t>(buckets)] = 0;
        ++buckets;
      }
      bucket = table_[at].bucket;
    }
    bucketOf_[p] = bucket;
    ++next_[static_cast<std::size_t>(bucket)];
  }
  bucketCount_ = buckets;
  return true;
}

}  // namespace percale
