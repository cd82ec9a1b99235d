#pragma once
/// \file
/// Numbers of vertices, triangles and the like are signed; containers count in std::size_t.

#include <cstddef>
#include <cstdint>

namespace percale {

/// A number that is not negative, as an index into a container.
inline std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

}  // namespace percale
