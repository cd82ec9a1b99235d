#pragma once
/// \file
/// Sparse matrices of scalars that keep rows that are alike only once.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace percale::fabric {

/// Rows are alike where they have the same values, to the bit, at the same places beside the diagonal: of a regular
/// grid of a million vertices some thousands are not. Where none are, this takes four bytes more per row than
/// compressed rows.
template <class T>
struct SharedRows {
  std::vector<std::int32_t> kind;    ///< Per row. Kinds are numbered in the order of the first rows of each.
  std::vector<std::int32_t> first;   ///< Per kind: its first entry; one more number at the end.
  std::vector<std::int32_t> offset;  ///< Per entry: its column minus its row, ascending in a kind.
  std::vector<T> value;              ///< Per entry.

  int rows() const { return static_cast<int>(kind.size()); }
  /// Calls visit(column, value) for the entries of a row.
  template <class Visit>
  void ForRow(std::int32_t row, Visit&& visit) const {
    const auto k = static_cast<std::size_t>(kind[static_cast<std::size_t>(row)]);
    for (auto e = static_cast<std::size_t>(first[k]); e < static_cast<std::size_t>(first[k + 1]); ++e)
      visit(row + offset[e], value[e]);
  }
  std::size_t MemoryBytes() const {
    return (kind.capacity() + first.capacity() + offset.capacity()) * sizeof(std::int32_t) +
           value.capacity() * sizeof(T);
  }
};

/// Makes SharedRows row by row.
template <class T>
class RowSharer {
 public:
  explicit RowSharer(int rows) {
    rows_.kind.reserve(static_cast<std::size_t>(rows));
    rows_.first.push_back(0);
    kindAt_.assign(64, -1);
  }

  /// Adds a row of (column, value), its columns ascending.
  void Append(std::span<const std::pair<std::int32_t, T>> row) {
    const std::int32_t number = rows_.rows();
    for (const auto& [column, value] : row) {
      rows_.offset.push_back(column - number);
      rows_.value.push_back(value);
    }
    const auto kinds = static_cast<std::int32_t>(rows_.first.size()) - 1;
    rows_.first.push_back(static_cast<std::int32_t>(rows_.offset.size()));
    std::int32_t& place = kindAt_[Place(kinds)];
    if (place >= 0) {  // seen before
      rows_.kind.push_back(place);
      rows_.first.pop_back();
      rows_.offset.resize(static_cast<std::size_t>(rows_.first.back()));
      rows_.value.resize(rows_.offset.size());
      return;
    }
    place = kinds;
    rows_.kind.push_back(kinds);
    if (2 * rows_.first.size() > kindAt_.size()) Grow();
  }

  SharedRows<T> Take() {
    rows_.first.shrink_to_fit();
    rows_.offset.shrink_to_fit();
    rows_.value.shrink_to_fit();
    kindAt_ = std::vector<std::int32_t>();
    return std::move(rows_);
  }

 private:
  std::size_t Begin(std::int32_t kind) const {
    return static_cast<std::size_t>(rows_.first[static_cast<std::size_t>(kind)]);
  }
  std::size_t Size(std::int32_t kind) const { return Begin(kind + 1) - Begin(kind); }

  bool Alike(std::int32_t a, std::int32_t b) const {
    const std::size_t size = Size(a);
    if (size == 0 || size != Size(b)) return size == Size(b);
    return std::memcmp(&rows_.offset[Begin(a)], &rows_.offset[Begin(b)], size * sizeof(std::int32_t)) == 0 &&
           std::memcmp(&rows_.value[Begin(a)], &rows_.value[Begin(b)], size * sizeof(T)) == 0;
  }

  /// Where in the hash table a kind that is alike is, or would be: linear probing (Knuth, TAOCP 3, section 6.4).
  std::size_t Place(std::int32_t kind) const {
    std::uint64_t hash = Size(kind);
    const auto add = [&](std::uint64_t bits) {
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    };
    for (std::size_t e = Begin(kind); e < Begin(kind + 1); ++e) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &rows_.value[e], sizeof(T));
      add(bits);
      add(static_cast<std::uint32_t>(rows_.offset[e]));
    }
    std::size_t place = hash & (kindAt_.size() - 1);
    while (kindAt_[place] >= 0 && !Alike(kindAt_[place], kind)) place = (place + 1) & (kindAt_.size() - 1);
    return place;
  }

  void Grow() {
    kindAt_.assign(2 * kindAt_.size(), -1);
    const auto kinds = static_cast<std::int32_t>(rows_.first.size()) - 1;
    for (std::int32_t kind = 0; kind < kinds; ++kind) kindAt_[Place(kind)] = kind;
  }

  SharedRows<T> rows_;
  std::vector<std::int32_t> kindAt_;  // hash table: kinds, -1 where it is free; a power of two, half of them free
};

}  // namespace percale::fabric
