#pragma once
/// \file
/// What every engine tells World about the state of its cloths.

#include <cstdint>

namespace percale {

/// A vertex of a cloth; cloth -1: none.
struct VertexRef {
  int cloth = -1, vertex = -1;
};

/// The longest spring or edge, measured against its rest length.
struct Stretch {
  double ratio = 0;  ///< Length over rest length.
  VertexRef at;      ///< One of its ends.
};

/// What an engine did since its counts were last taken.
struct EngineCounts {
  std::int64_t selfContacts = 0, colliderContacts = 0, limitedSprings = 0;
  std::int64_t intersections = 0, squeezed = 0;  ///< As the last step left them.
  int jumps = 0;                                 ///< Of colliders.
  double lostWay = 0, wantedWay = 0;             ///< Of all vertices [m].
  int splits = 0;
  std::int64_t contactBytes = 0;  ///< As it is now.
  int newtonIterations = 0, linearIterations = 0;
  double residual = 0;
  bool converged = true;
};

}  // namespace percale
