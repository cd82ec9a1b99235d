#pragma once
/// \file
/// The judge: where a mesh passes through itself, decided exactly and by nothing that the solver uses. It says whether
/// what the solver promises holds.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/executor.h"
#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale {

/// An edge and a triangle that have a point in common.
struct Intersection {
  std::int32_t edge[2] = {0, 0};  ///< Its vertices, the lower first.
  std::int32_t triangle = 0;      ///< Its index.
  friend bool operator==(const Intersection&, const Intersection&) = default;
};

struct IntersectionCount {
  std::int64_t count = 0;           ///< Pairs of an edge and a triangle.
  std::vector<Intersection> first;  ///< The first of them, ascending by edge, then triangle.
};

/// Counts the pairs of an edge and a triangle of a mesh that have a point in common. Exact: of the positions as they
/// are, touching counts, and no pair is missed or invented. Two triangles meet elsewhere than in the vertices and edges
/// that they share just where such a pair is among them.
///
/// A pair with one vertex in common counts where the edge goes on in the triangle's plane, over the triangle or along a
/// side: so shows a fold that lies exactly flat on itself. A pair with two in common never counts.
///
/// Several meshes are given as one, indices shifted.
class IntersectionJudge {
 public:
  /// The corners of each triangle are three different ones of the vertices 0 .. vertices - 1. The triangles must
  /// outlive it.
  IntersectionJudge(int vertices, std::span<const Triangle> triangles);
  /// Vertices from `obstacles` on belong to obstacles, which may intersect one another.
  IntersectionJudge(int vertices, std::span<const Triangle> triangles, int obstacles);
  ~IntersectionJudge();
  IntersectionJudge(IntersectionJudge&&) noexcept;
  IntersectionJudge& operator=(IntersectionJudge&&) noexcept;

  /// `positions`: one per vertex [m], each coordinate at most 1e90 in size; one below 1e-90 counts as 0. Lists the
  /// first `most` pairs. The result depends neither on the number of threads nor on what was counted before.
  IntersectionCount Count(std::span<const Vec3> positions, const Executor& executor, int most = 10);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace percale
