#pragma once
/// \file
/// How the blocks of a matrix are summed from those of triangles.

#include <cstdint>
#include <span>

#include "fabric/slots.h"
#include "fabric/system_matrix.h"
#include "mesh/lists.h"
#include "percale/mesh.h"

namespace percale::fabric {

/// A block off the diagonal, of a vertex and a neighbour, is the sum of those of the triangles with both: that between
/// a corner and the next where the vertex comes first, and the transposed one where the neighbour does. Each is a
/// number, those of a row in the order of its blocks and of the sums: the former ones first, each by triangle.
struct BlockPart {
  /// Which corner of its triangle is the first of the block, where the vertex is corner k.
  enum class From : std::uint32_t { Own = 0, Before = 1, TwoBehind = 2 };  // k, k - 1, k + 2

  std::uint32_t corner = 0;  ///< Place of the vertex's corner among those of its vertex.
  From from = From::Own;     ///< Transposed where it is another.
  bool last = false;         ///< Whether it is the last of its block.

  std::uint32_t Code() const { return corner << 3 | static_cast<std::uint32_t>(from) << 1 | (last ? 1u : 0u); }
};

/// `pattern`: MakePattern of the triangles. `corners`: per vertex its corners, 3 * triangle + 0, 1, 2, ascending. The
/// parts of row v start at 2 * corners.first[v].
Slots FindBlockParts(const BlockPattern& pattern, std::span<const Triangle> triangles, const Lists& corners);

}  // namespace percale::fabric
