#pragma once
/// \file
/// What takes a motion of few nodes to one of many vertices: the interpolation between the levels of multigrid. Built
/// once per model.

#include <cstdint>
#include <span>
#include <vector>

#include "fabric/real.h"
#include "fabric/system_matrix.h"
#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale::fabric {

/// P in compressed rows: a row per vertex of the finer level, a column per node of the coarser one, a weight for all
/// three components. Weights of a row add up to one, so that the whole moves as one; rows of pinned vertices are empty,
/// and so are those of vertices without neighbours that move.
struct Prolongation {
  int nodes = 0;                     ///< Columns.
  std::vector<std::int32_t> first;   ///< Per row: its first entry; one more number at the end.
  std::vector<std::int32_t> column;  ///< Per entry, ascending in a row.
  std::vector<Real> weight;          ///< Per entry, > 0.

  int rows() const { return static_cast<int>(first.size()) - 1; }
};

/// P' of a P, which has its numbers.
struct Restriction {
  std::vector<std::int32_t> firstRow;  ///< Per node: the least row of P with a weight for it.
  SharedRows<std::int32_t> entry;      ///< Per node those rows, ascending, less that one; the value is the place of the
                                       ///< weight in its row.

  /// Calls visit(row, weight) for each of a node's weights.
  template <class Visit>
  void ForRow(const Prolongation& p, std::int32_t node, Visit&& visit) const {
    entry.ForRow(node, firstRow[static_cast<std::size_t>(node)], [&](std::int32_t row, std::int32_t place) {
      visit(row, p.weight[static_cast<std::size_t>(p.first[static_cast<std::size_t>(row)] + place)]);
    });
  }
  std::size_t MemoryBytes() const { return firstRow.capacity() * sizeof(std::int32_t) + entry.MemoryBytes(); }
};

Restriction MakeRestriction(const Prolongation& prolongation);

/// Coordinates in the cloth as it was cut, in metres, in as many pieces as there are panels. Where panels are sewn
/// together a vertex has more than one point of material.
struct MaterialMesh {
  std::span<const Triangle> triangles;          ///< Of vertices.
  std::span<const Triangle> materialTriangles;  ///< The same triangles, of points of the material.
  std::span<const Vec2> material;               ///< Those points [m].
};

/// The pattern of P' A P for A of `pattern`.
BlockPattern CoarsePattern(const BlockPattern& pattern, const Prolongation& prolongation,
                           const Restriction& restriction);

/// Levels by material coordinates: over each panel a grid with a node per 4 x 4 vertices or so, bilinear in between,
/// then the same over those nodes and so on; a vertex of several panels takes the mean of them. `vertices`: how many
/// there are; `pinned`: per vertex, or nothing. Stops at kFewNodes, or where that does not make fewer nodes, or at once
/// where coordinates are missing, not finite or all on one line.
std::vector<Prolongation> MaterialHierarchy(int vertices, const MaterialMesh& mesh,
                                            std::span<const std::uint8_t> pinned = {});

/// Levels by smoothed aggregation (Vanek, Mandel, Brezina 1996, "Algebraic multigrid by smoothed aggregation for second
/// and fourth order elliptic problems") of the graph of `pattern`, with its Laplacian in place of the matrix:
/// aggregates of a vertex and its neighbours and what is left between them, 3 x 3 or so. Stops at kFewNodes, or where
/// that does not make fewer nodes.
std::vector<Prolongation> AggregateHierarchy(const BlockPattern& pattern, std::span<const std::uint8_t> pinned = {});

/// The first of the two as far as it gets, and then the second over its last nodes.
std::vector<Prolongation> MakeHierarchy(const BlockPattern& pattern, const MaterialMesh& mesh,
                                        std::span<const std::uint8_t> pinned = {});

/// Of so few nodes no coarser level is made: three unknowns each, they are solved for directly, and factored in 0.16
/// ms.
inline constexpr int kFewNodes = 60;

}  // namespace percale::fabric
