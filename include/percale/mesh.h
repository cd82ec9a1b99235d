#pragma once
/// \file
/// The elements of a mesh, as indices of its vertices.

#include <array>
#include <cstdint>

#include "percale/vec3.h"

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

/// Two things in contact at the end of a step, and how strongly they hold each other.
struct Touch {
  std::int32_t kind = 0;                 ///< 0: a vertex and a triangle; 1: two edges; 2: a vertex and a solid.
  std::array<std::int32_t, 4> number{};  ///< Their vertices, of all cloths and then of obstacles; or the vertex and the
                                         ///< number of the solid.
  Vec3 hold;                             ///< Force of friction on the second [N].
  double force = 0;                      ///< That presses them together [N].
  friend bool operator==(const Touch&, const Touch&) = default;
};

}  // namespace percale
