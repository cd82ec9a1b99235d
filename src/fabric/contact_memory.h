#pragma once
/// \file
/// What a contact leaves behind for the next step: how strongly it pressed, and held.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/vector3.h"

namespace percale::fabric {

/// What touches: four vertices and how they pair, or a vertex and the number of a shape. What is tangled is not
/// remembered.
struct ContactKey {
  enum class Kind : std::int32_t { VertexTriangle, EdgeEdge, Shape, Tangle };
  Kind kind = Kind::VertexTriangle;
  std::array<std::int32_t, 4> number{};
  friend bool operator==(const ContactKey&, const ContactKey&) = default;
};

struct Stick {
  Vector3<double> hold;  ///< Force of friction [N].
  double force = 0;      ///< Normal to the contact [N].
};

/// A hash table by linear probing (Knuth, TAOCP 3, section 6.4, algorithm L). Grows, and never shrinks.
class ContactMemory {
 public:
  void Clear(std::size_t expected) {
    std::size_t size = 64;
    while (size < 2 * expected) size *= 2;
    if (entries_.size() < size) entries_.resize(size);
    for (Entry& entry : entries_) entry.used = false;
  }
  void Put(const ContactKey& key, const Stick& stick) { entries_[Place(key)] = {key, stick, true}; }
  /// Null where there is none.
  const Stick* Find(const ContactKey& key) const {
    if (entries_.empty()) return nullptr;
    const Entry& entry = entries_[Place(key)];
    return entry.used ? &entry.stick : nullptr;
  }

  std::size_t Bytes() const { return entries_.capacity() * sizeof(Entry); }

  /// Calls body(key, stick) for all, in any order.
  template <class Body>
  void ForAll(Body&& body) const {
    for (const Entry& entry : entries_) {
      if (entry.used) body(entry.key, entry.stick);
    }
  }

 private:
  struct Entry {
    ContactKey key;
    Stick stick;
    bool used = false;
  };

  /// Where the key is, or would be.
  std::size_t Place(const ContactKey& key) const {
    std::uint64_t hash = static_cast<std::uint64_t>(key.kind) + 1;
    for (const std::int32_t number : key.number) {
      hash = (hash ^ static_cast<std::uint32_t>(number)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    std::size_t place = hash & (entries_.size() - 1);
    while (entries_[place].used && !(entries_[place].key == key)) place = (place + 1) & (entries_.size() - 1);
    return place;
  }

  std::vector<Entry> entries_;  // a power of two, half of them free
};

}  // namespace percale::fabric
