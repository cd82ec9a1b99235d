#pragma once
/// \file
/// Small numbers, as lists of places near something are.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fabric/shared_rows.h"

namespace percale::fabric {

/// Numbers below 2^32, in one byte each where all are below 2^8, as those of meshes are that are no fans.
class Slots {
 public:
  void push_back(std::ptrdiff_t slot) {
    assert(slot >= 0 && slot <= 0xffffffff);
    if (wide_.empty() && slot <= 0xff) return narrow_.push_back(static_cast<std::uint8_t>(slot));
    wide_.insert(wide_.end(), narrow_.begin(), narrow_.end());
    narrow_.clear();
    wide_.push_back(static_cast<std::uint32_t>(slot));
  }
  std::uint32_t operator[](std::size_t index) const { return wide_.empty() ? narrow_[index] : wide_[index]; }
  /// Keeps the first `size` of them.
  void Truncate(std::size_t size) {
    if (wide_.empty())
      narrow_.resize(size);
    else
      wide_.resize(size);
  }
  void reserve(std::size_t slots) { narrow_.reserve(slots); }
  void shrink_to_fit() {
    narrow_.shrink_to_fit();
    wide_.shrink_to_fit();
  }
  std::int32_t size() const { return static_cast<std::int32_t>(narrow_.size() + wide_.size()); }
  std::size_t Bytes() const { return narrow_.capacity() + sizeof(std::uint32_t) * wide_.capacity(); }
  /// One of the two has all, the other is null.
  const std::uint8_t* narrow() const { return wide_.empty() ? narrow_.data() : nullptr; }
  const std::uint32_t* wide() const { return wide_.empty() ? nullptr : wide_.data(); }
  /// Calls visit(array), of either type.
  template <class Visit>
  void InArray(Visit&& visit) const {
    if (wide_.empty())
      visit(narrow_.data());
    else
      visit(wide_.data());
  }

 private:
  std::vector<std::uint8_t> narrow_;
  std::vector<std::uint32_t> wide_;
};

/// Lists of slots, those that are alike kept once: so are nearly all that tell of a regular grid.
class SlotLists {
 public:
  void Add(std::span<const std::uint32_t> list) {
    for (const std::uint32_t slot : list) slots_.push_back(slot);
    const auto kinds = static_cast<std::int32_t>(first_.size()) - 1;
    first_.push_back(slots_.size());
    const std::int32_t kind = table_.Find(
        kinds, [&](std::int32_t k) { return Hash(k); }, [&](std::int32_t a, std::int32_t b) { return Alike(a, b); });
    kind_.push_back(kind);
    if (kind == kinds) return;
    first_.pop_back();
    slots_.Truncate(static_cast<std::size_t>(first_.back()));
  }
  /// There will be no more.
  void Finish() {
    kind_.shrink_to_fit();
    first_.shrink_to_fit();
    slots_.shrink_to_fit();
    table_ = KindTable();
  }
  /// Where a list starts in the array that InArray gives.
  std::int32_t First(std::int32_t list) const {
    return first_[static_cast<std::size_t>(kind_[static_cast<std::size_t>(list)])];
  }
  /// Calls visit(array) with all slots.
  template <class Visit>
  void InArray(Visit&& visit) const {
    slots_.InArray(visit);
  }
  std::size_t Bytes() const { return slots_.Bytes() + sizeof(std::int32_t) * (kind_.capacity() + first_.capacity()); }

 private:
  std::size_t Begin(std::int32_t kind) const {
    return static_cast<std::size_t>(first_[static_cast<std::size_t>(kind)]);
  }
  std::uint64_t Hash(std::int32_t kind) const {
    std::uint64_t hash = 0;
    for (std::size_t s = Begin(kind); s < Begin(kind + 1); ++s) hash = KindTable::Mix(hash, slots_[s] + 1);
    return hash;
  }
  bool Alike(std::int32_t a, std::int32_t b) const {
    const std::size_t size = Begin(a + 1) - Begin(a);
    if (Begin(b + 1) - Begin(b) != size) return false;
    for (std::size_t s = 0; s < size; ++s) {
      if (slots_[Begin(a) + s] != slots_[Begin(b) + s]) return false;
    }
    return true;
  }

  std::vector<std::int32_t> kind_;         // per list
  std::vector<std::int32_t> first_ = {0};  // per kind, and the end
  Slots slots_;
  KindTable table_;
};

}  // namespace percale::fabric
