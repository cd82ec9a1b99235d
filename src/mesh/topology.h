#pragma once
/// \file
/// Which triangles meet where. All lists depend on the triangles' indices alone, and are in a stated order.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "percale/rest_mesh.h"

namespace percale {

/// Corner k (0, 1, 2 for a, b, c) of triangle t has the number 3 t + k, and so has the side from it to the next corner.
struct Topology {
  std::vector<Edge> edges;                                 ///< a < b; ascending by a, then b.
  std::vector<std::array<std::int32_t, 2>> edgeTriangles;  ///< At most two; -1: none. The one that runs from a to b
                                                           ///< comes first, else the lower. A hinge has both, a
                                                           ///< boundary edge t and -1, a non-manifold edge none.
  std::vector<std::array<std::int32_t, 2>> edgeOpposite;   ///< The vertices of these that face the edge, or -1.
  std::vector<std::int32_t> sideEdges;                     ///< The edge of each side; 3 per triangle.
  std::vector<std::int32_t> boundaryEdges;                 ///< Edges of one triangle, ascending.
  std::vector<std::int32_t> nonManifoldEdges;              ///< Edges of more than two triangles, ascending.
  std::vector<std::int32_t> inconsistentEdges;             ///< Edges that two triangles run the same way, ascending.
  std::vector<std::int32_t> cornerBegin;                   ///< Vertex v has the corners at cornerBegin[v] up to
  std::vector<std::int32_t> corners;                       ///< cornerBegin[v + 1] of `corners`, ascending.
  std::vector<std::int32_t> component;                     ///< Per vertex: pieces that hang together by vertices,
                                                           ///< numbered by their lowest vertex; -1 for lone vertices.
  int componentCount = 0;
};

/// The topology of triangles whose indices are 0 .. vertexCount - 1, three different ones each; at most 2^31 / 3
/// triangles. Takes time in proportion to their number.
Topology BuildTopology(std::size_t vertexCount, std::span<const Triangle> triangles);

/// Which triangles to turn over so that neighbours run their common edges in opposite ways: `turn` holds them,
/// ascending. In each patch (triangles joined by edges of two) the fewer are turned, of equally many those that are not
/// like its lowest triangle. Patches with one side only, such as Moebius strips, are left alone: `oneSided` holds the
/// lowest triangle of each.
struct TurnedTriangles {
  std::vector<std::int32_t> turn, oneSided;
};
TurnedTriangles FindOrientation(const Topology& topology);

/// The vertices in the order in which a Hilbert curve through their box meets them (Skilling 2004, "Programming the
/// Hilbert curve"), of those in one of its 2^63 cells the lower first: neighbours in space are neighbours in memory.
/// `positions` must be finite.
std::vector<std::int32_t> LocalityOrder(std::span<const Vec3> positions);

/// Renumbers the vertices: number i becomes what was order[i], a permutation. Triangles keep their corners, and go in
/// ascending order of their lowest vertex.
void ReorderMesh(RestMesh& mesh, std::span<const std::int32_t> order);

}  // namespace percale
