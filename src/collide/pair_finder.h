#pragma once
/// \file
/// Finds what comes close to what while all vertices of a mesh move along straight lines.

#include <cstdint>
#include <memory>
#include <span>

#include "collide/contact_mesh.h"
#include "collide/kernels.h"
#include "core/executor.h"
#include "percale/vec3.h"

namespace percale {

/// From start to start + way, all vertices in common time.
struct MeshMotion {
  std::span<const Vec3> start;        ///< Per vertex [m].
  std::span<const Vec3> way;          ///< Per vertex [m].
  std::span<const std::uint8_t> cut;  ///< Per vertex: 1 where it may end anywhere between; or nothing: none may.
};

class PairFinder {
 public:
  /// The mesh has its clusters. It must outlive the finder, and so must the executor.
  PairFinder(const ContactMesh& mesh, const Executor& executor);
  /// With kernels other than the fastest, which find the same.
  PairFinder(const ContactMesh& mesh, const Executor& executor, const collide::Kernels& kernels);
  ~PairFinder();

  /// Lists pairs of a vertex and a triangle, and of two edges, whose boxes come within reach[body] + reach[other body]
  /// of each other: all that come as close as that in distance, and some more. None with a vertex in common, none of
  /// two obstacles, and none of two cloths where `clothPairs` is false. Always in the same order. What is farther than
  /// 1e30 m or not a number comes near nothing. Allocates only where there are more than ever before. `reach`: per
  /// body [m].
  void Find(const MeshMotion& motion, std::span<const double> reach, bool clothPairs);

  std::span<const VertexQuad> vertexTriangle() const;  ///< {vertex, a, b, c}: triangles as the mesh has them.
  std::span<const VertexQuad> edgeEdge() const;        ///< {a, b, c, d}: edges ab and cd, as the mesh has them.
  std::size_t MemoryBytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
