#pragma once
/// \file
/// The elements of a mesh, as indices of its vertices.

#include <cstdint>

namespace percale {

struct Triangle {
  std::int32_t a = 0, b = 0, c = 0;
  friend bool operator==(const Triangle&, const Triangle&) = default;
};
struct Edge {
  std::int32_t a = 0, b = 0;
  friend bool operator==(const Edge&, const Edge&) = default;
};

}  // namespace percale
