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

/// SharedRows as loops read them.
template <class T>
struct SharedRowsView {
  const std::int32_t* kind;
  const std::int32_t* first;
  const std::int32_t* offset;
  const T* value;
};

/// Rows are alike where they have the same values, to the bit, at the same places beside the diagonal: of a regular
/// grid of a million vertices some thousands are not. Where none are, this takes four bytes more per row than
/// compressed rows.
template <class T>
struct SharedRows {
  std::vector<std::int32_t> kind;    ///< Per row. Kinds are numbered in the order of the first rows of each.
  std::vector<std::int32_t> first;   ///< Per kind: its first entry; one more number at the end.
  std::vector<std::int32_t> offset;  ///< Per entry: its column minus its row, or the origin.
  std::vector<T> value;              ///< Per entry.

  int rows() const { return static_cast<int>(kind.size()); }
  /// Calls visit(column, value) for the entries of a row.
  template <class Visit>
  void ForRow(std::int32_t row, Visit&& visit) const {
    ForRow(row, row, visit);
  }
  /// The same where columns count from `origin` instead of the row's own number.
  template <class Visit>
  void ForRow(std::int32_t row, std::int32_t origin, Visit&& visit) const {
    const auto k = static_cast<std::size_t>(kind[static_cast<std::size_t>(row)]);
    for (auto e = static_cast<std::size_t>(first[k]); e < static_cast<std::size_t>(first[k + 1]); ++e)
      visit(origin + offset[e], value[e]);
  }
  SharedRowsView<T> View() const { return {kind.data(), first.data(), offset.data(), value.data()}; }
  std::size_t MemoryBytes() const {
    return (kind.capacity() + first.capacity() + offset.capacity()) * sizeof(std::int32_t) +
           value.capacity() * sizeof(T);
  }
};

/// Numbers kinds of things: a hash table by linear probing (Knuth, TAOCP 3, section 6.4).
class KindTable {
 public:
  /// `next`: how many kinds there are, and what lies behind the last of them. Returns the kind that is alike; where
  /// there is none `next`, which is one then. hash(kind) and alike(kind, kind) tell what they hold.
  template <class Hash, class Alike>
  std::int32_t Find(std::int32_t next, Hash&& hash, Alike&& alike) {
    std::size_t place = Home(hash(next));
    while (kindAt_[place] >= 0 && !alike(kindAt_[place], next)) place = Behind(place);
    if (kindAt_[place] >= 0) return kindAt_[place];
    kindAt_[place] = next;
    if (2 * (static_cast<std::size_t>(next) + 1) > kindAt_.size()) Grow(next + 1, hash);
    return next;
  }
  /// Adds to what was hashed.
  static std::uint64_t Mix(std::uint64_t hash, std::uint64_t bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 29;
  }

 private:
  std::size_t Home(std::uint64_t hash) const { return hash & (kindAt_.size() - 1); }
  std::size_t Behind(std::size_t place) const { return (place + 1) & (kindAt_.size() - 1); }
  template <class Hash>
  void Grow(std::int32_t kinds, Hash&& hash) {
    kindAt_.assign(2 * kindAt_.size(), -1);
    for (std::int32_t kind = 0; kind < kinds; ++kind) {
      std::size_t place = Home(hash(kind));
      while (kindAt_[place] >= 0) place = Behind(place);
      kindAt_[place] = kind;
    }
  }

  std::vector<std::int32_t> kindAt_ = std::vector<std::int32_t>(64, -1);  // -1: free; a power of two, half of them free
};

/// Makes SharedRows row by row.
template <class T>
class RowSharer {
 public:
  explicit RowSharer(int rows) {
    rows_.kind.reserve(static_cast<std::size_t>(rows));
    rows_.first.push_back(0);
  }

  /// Adds a row of (column, value).
  void Append(std::span<const std::pair<std::int32_t, T>> row) { Append(row, rows_.rows()); }
  /// The same with columns that count from `origin` instead of the row's own number.
  void Append(std::span<const std::pair<std::int32_t, T>> row, std::int32_t origin) {
    for (const auto& [column, value] : row) {
      rows_.offset.push_back(column - origin);
      rows_.value.push_back(value);
    }
    const auto kinds = static_cast<std::int32_t>(rows_.first.size()) - 1;
    rows_.first.push_back(static_cast<std::int32_t>(rows_.offset.size()));
    const std::int32_t kind = table_.Find(
        kinds, [&](std::int32_t k) { return Hash(k); }, [&](std::int32_t a, std::int32_t b) { return Alike(a, b); });
    rows_.kind.push_back(kind);
    if (kind == kinds) return;
    rows_.first.pop_back();
    rows_.offset.resize(static_cast<std::size_t>(rows_.first.back()));
    rows_.value.resize(rows_.offset.size());
  }

  SharedRows<T> Take() {
    rows_.first.shrink_to_fit();
    rows_.offset.shrink_to_fit();
    rows_.value.shrink_to_fit();
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

  std::uint64_t Hash(std::int32_t kind) const {
    std::uint64_t hash = Size(kind);
    for (std::size_t e = Begin(kind); e < Begin(kind + 1); ++e) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &rows_.value[e], sizeof(T));
      hash = KindTable::Mix(KindTable::Mix(hash, bits), static_cast<std::uint32_t>(rows_.offset[e]));
    }
    return hash;
  }

  SharedRows<T> rows_;
  KindTable table_;
};

}  // namespace percale::fabric
