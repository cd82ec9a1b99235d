#include "collide/box_map.h"

#include <algorithm>
#include <cassert>

namespace percale {

void BoxMap::Reserve(int points) {
  const auto count = static_cast<std::size_t>(points);
  int bits = 4;
  while ((std::size_t{1} << bits) < 2 * count) ++bits;  // at most half full
  table_.assign(std::size_t{1} << bits, {});
  tableShift_ = 64 - bits;
  build_ = 0;
  bucketCount_ = 0;
  bucketOf_.resize(count);
  first_.assign(count + 1, 0);
  next_.resize(count);
  members_.resize(count);
}

void BoxMap::Build(std::span<const std::uint64_t> keys) {
  assert(keys.size() <= members_.size());
  if (++build_ == 0) {  // the counter came round: old builds could be taken for new ones
    std::fill(table_.begin(), table_.end(), Slot{});
    build_ = 1;
  }
  const std::size_t mask = table_.size() - 1;
  std::int32_t buckets = 0;
  std::uint64_t lastKey = keys.empty() ? 0 : ~keys[0];
  std::int32_t lastBucket = -1;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    const std::uint64_t key = keys[p];
    if (key != lastKey) {  // neighbours in the grid mostly share their box
      lastKey = key;
      std::size_t at = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> tableShift_);
      while (table_[at].build == build_ && table_[at].key != key) at = (at + 1) & mask;
      if (table_[at].build != build_) {
        table_[at] = {key, build_, buckets};
        next_[static_cast<std::size_t>(buckets)] = 0;
        ++buckets;
      }
      lastBucket = table_[at].bucket;
    }
    bucketOf_[p] = lastBucket;
    ++next_[static_cast<std::size_t>(lastBucket)];
  }
  bucketCount_ = buckets;

  std::int32_t before = 0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(buckets); ++b) {
    first_[b] = before;
    before += next_[b];
    next_[b] = first_[b];
  }
  first_[static_cast<std::size_t>(buckets)] = before;
  for (std::size_t p = 0; p < keys.size(); ++p) {
    members_[static_cast<std::size_t>(next_[static_cast<std::size_t>(bucketOf_[p])]++)] = static_cast<std::int32_t>(p);
  }
}

}  // namespace percale
