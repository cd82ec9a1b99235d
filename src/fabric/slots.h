#pragma once
/// \file
/// Small numbers, as lists of places near something are.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

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

}  // namespace percale::fabric
