#pragma once
/// \file
/// Lists that grow side by side, one per chunk of a parallel loop.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace percale {

/// Any thread may add to a list, but one thread at a time.
template <class T>
class ChunkLists {
 public:
  explicit ChunkLists(int lists) : lists_(static_cast<std::size_t>(lists)) {}

  int lists() const { return static_cast<int>(lists_.size()); }
  std::int64_t Count(int list) const { return At(list).count; }
  std::int64_t CountAll() const {
    std::int64_t sum = 0;
    for (const List& list : lists_) sum += list.count;
    return sum;
  }

  /// Empties all lists.
  void Clear() {
    std::fill(lists_.begin(), lists_.end(), List{});
    used_ = 0;
  }
  /// Makes room for as many entries again as there are now, in whatever lists they will be.
  void KeepRoom() {
    // The last block of each list may be nearly empty.
    const std::size_t blocks = static_cast<std::size_t>(CountAll() / kBlock) + lists_.size();
    while (blocks_.size() < blocks) blocks_.push_back(std::make_unique<Block>());
  }

  /// Where the next entries of a list go: room for one at least.
  std::span<T> Room(int list) {
    List& l = At(list);
    if (l.room == 0) {
      Block* const block = Take();
      (l.first == nullptr ? l.first : l.last->next) = block;
      l.last = block;
      l.room = kBlock;
    }
    return std::span<T>(l.last->entries).last(static_cast<std::size_t>(l.room));
  }
  /// So many entries were written there.
  void Add(int list, int entries) {
    List& l = At(list);
    l.count += entries;
    l.room -= entries;
  }

  /// Calls visit(entries) for all of a list, in order, some at a time.
  template <class Visit>
  void ForEntries(int list, Visit&& visit) const {
    const List& l = At(list);
    const Block* block = l.first;
    for (std::int64_t left = l.count; left > 0; left -= kBlock, block = block->next) {
      visit(std::span<const T>(block->entries, static_cast<std::size_t>(std::min<std::int64_t>(left, kBlock))));
    }
  }

  std::size_t MemoryBytes() const {
    return lists_.capacity() * sizeof(List) + blocks_.capacity() * sizeof blocks_[0] + blocks_.size() * sizeof(Block);
  }

 private:
  static constexpr int kBlock = 256;  // entries
  struct Block {
    T entries[kBlock];
    Block* next;
  };
  struct List {
    Block* first = nullptr;
    Block* last = nullptr;
    std::int64_t count = 0;
    int room = 0;  // in the last block
  };

  List& At(int list) { return lists_[static_cast<std::size_t>(list)]; }
  const List& At(int list) const { return lists_[static_cast<std::size_t>(list)]; }
  Block* Take() {
    const std::lock_guard lock(mutex_);
    if (used_ == blocks_.size()) blocks_.push_back(std::make_unique<Block>());
    return blocks_[used_++].get();
  }

  std::vector<List> lists_;
  std::vector<std::unique_ptr<Block>> blocks_;
  std::size_t used_ = 0;
  std::mutex mutex_;
};

}  // namespace percale
