#pragma once
/// \file
/// How a mesh is cut into leaves of a few triangles each: neighbours share a leaf, or have leaves near each other.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace percale {

/// Of all things those of a leaf: at [first[leaf], first[leaf + 1]).
template <class T>
std::span<const T> LeafPart(const std::vector<T>& all, const std::vector<std::int32_t>& first, int leaf) {
  const std::int32_t begin = first[static_cast<std::size_t>(leaf)], end = first[static_cast<std::size_t>(leaf) + 1];
  return {all.data() + begin, static_cast<std::size_t>(end - begin)};
}

/// An item is a triangle, an edge without triangles or a vertex without edges. The items of a body are cut in two along
/// the longest axis again and again; what is left are its leaves. Each vertex and each edge belongs to the first leaf
/// that has an item with it.
struct Clusters {
  static constexpr int kLeafItems = 16;  ///< At most; so it has at most 48 vertices and 48 edges.

  int clothLeaves = 0;                         ///< Leaves from here on are those of obstacles.
  std::vector<std::int32_t> body;              ///< Per leaf, ascending.
  std::vector<std::uint8_t> hasOnlyTriangles;  ///< Per leaf: 0 where it has other items as well.
  std::vector<std::int32_t> vertexFirst;    ///< Leaf l has the vertices at [vertexFirst[l], vertexFirst[l + 1]) of ...
  std::vector<std::int32_t> vertices;       ///< ... these: first its own, then others of its triangles.
  std::vector<std::int32_t> ownVertices;    ///< Per leaf, how many are its own.
  std::vector<std::int32_t> edgeFirst;      ///< Leaf l has the mesh's edges at [edgeFirst[l], edgeFirst[l + 1]).
  std::vector<std::int32_t> triangleFirst;  ///< Likewise its triangles.

  int leaves() const { return static_cast<int>(body.size()); }
  std::span<const std::int32_t> Vertices(int leaf) const { return LeafPart(vertices, vertexFirst, leaf); }
  std::span<const std::int32_t> OwnVertices(int leaf) const {
    return Vertices(leaf).first(static_cast<std::size_t>(ownVertices[static_cast<std::size_t>(leaf)]));
  }
  std::size_t MemoryBytes() const;
};

struct ContactMesh;

/// The same mesh with its clusters: its edges and triangles are sorted leaf by leaf, and no array has room to spare.
/// Takes time in proportion to n log n.
ContactMesh Clustered(ContactMesh mesh);

}  // namespace percale
