#pragma once
/// \file
/// How much memory there is, so that a scene that cannot fit is refused before it is allocated, and what of it is used.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace percale {

/// What an array occupies.
template <class T, class Allocator>
std::size_t BytesOf(const std::vector<T, Allocator>& array) {
  return array.capacity() * sizeof(T);
}

/// Bytes of memory that this process may use: the machine's, or its container's where that is less
/// (Linux). 0 where the system does not say.
std::uint64_t AvailableMemory();

/// The most bytes that this process has had in memory at once. 0 where the system does not say (Windows).
std::uint64_t PeakMemory();

}  // namespace percale
