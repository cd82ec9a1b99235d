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

/// What the edge between two triangles remembers of having been folded.
struct Fold {
  double rest = 0;   ///< Angle that it bends back to [rad]; 0: flat.
  double moved = 0;  ///< By how much that has moved, in all [rad].
  friend bool operator==(const Fold&, const Fold&) = default;
};

}  // namespace percale
