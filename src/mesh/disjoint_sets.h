#pragma once
/// \file
/// What hangs together, found pair by pair.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace percale {

/// Sets of the numbers below a count, each named by its least (union by least, path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  std::int32_t Find(std::int32_t i) {
    while (At(i) != i) i = At(i) = At(At(i));
    return i;
  }
  void Join(std::int32_t i, std::int32_t k) {
    const std::int32_t a = Find(i), b = Find(k);
    At(std::max(a, b)) = std::min(a, b);
  }

 private:
  std::int32_t& At(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<std::int32_t> parent_;
};

}  // namespace percale
