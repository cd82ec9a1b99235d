#pragma once
/// \file
/// Everything that may touch: the vertices, edges and triangles of all cloths, and behind them those of obstacles.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collide/clusters.h"
#include "core/memory.h"
#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale {

/// Four vertices: a vertex and the corners of a triangle, or the ends of one edge and of another.
using VertexQuad = std::array<std::int32_t, 4>;

/// Filled in any order of edges and triangles first; then `Clustered` sorts them and adds the clusters.
struct ContactMesh {
  int clothVertices = 0;            ///< Vertices from here on belong to obstacles.
  int clothBodies = 0;              ///< Bodies from here on are obstacles.
  std::vector<std::int32_t> body;   ///< Per vertex, ascending; a cloth or an obstacle each.
  std::vector<Vec3> place;          ///< Per vertex: neighbours in the mesh lie near each other here [m].
  std::vector<Edge> edges;          ///< Of the triangles and others, each once; with clusters leaf by leaf, ...
  std::vector<Triangle> triangles;  ///< ... likewise these, so that those of obstacles come behind those of cloths.
  Clusters clusters;                ///< None before `Clustered`.

  int vertices() const { return static_cast<int>(body.size()); }
  int bodies() const { return body.empty() ? 0 : body.back() + 1; }
  /// Those of a leaf.
  std::span<const Edge> Edges(int leaf) const { return LeafPart(edges, clusters.edgeFirst, leaf); }
  std::span<const Triangle> Triangles(int leaf) const { return LeafPart(triangles, clusters.triangleFirst, leaf); }
  std::size_t MemoryBytes() const {
    return BytesOf(body) + BytesOf(place) + BytesOf(edges) + BytesOf(triangles) + clusters.MemoryBytes();
  }
};

}  // namespace percale
