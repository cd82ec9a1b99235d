#pragma once
/// \file
/// Cloth that is tangled: what of it is let be, and which way it comes apart.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/intersections.h"
#include "collide/proximity.h"
#include "math/vector3.h"
#include "mesh/lists.h"
#include "percale/vec3.h"

namespace percale {

/// An edge that passes through a triangle, and where it has to go.
struct Tangle {
  std::int32_t vertex = 0;               ///< The end of the edge that is pulled.
  std::array<std::int32_t, 3> corner{};  ///< Of the triangle.
  std::array<double, 3> weight{};        ///< Of its corners, where they meet.
  Vector3<double> direction;             ///< Of length 1: that way the vertex, and the triangle the other.
};

class Untangler {
 public:
  /// The mesh must outlive it.
  explicit Untangler(const ContactMesh& mesh);

  /// What is tangled from now on; nothing if none are given.
  void Take(std::vector<Intersection> met);
  std::span<const Intersection> met() const { return met_; }

  /// Whether a pair is to be let be, so that what is tangled can come apart: where two cloths meet along a curve, what
  /// lies within kRings edges of it in the one may pass through what does in the other, if they are no neighbours.
  bool LetsPass(PairKind kind, const VertexQuad& quad) const;
  static constexpr int kRings = 2;

  /// For each pair that is tangled its way; none where nothing tells one. `x`: positions. `free`: per vertex of cloth,
  /// whether it is not pinned. `tangles` is replaced.
  ///
  /// What is of a cloth nearer to one side of a curve than to the other, or to another curve, is a part of it. Of the
  /// parts along a curve the smallest goes back through the other cloth, if nothing of it is pinned (cf. Baraff,
  /// Witkin, Kass 2003, "Untangling cloth", which takes parts that are cut off altogether). If that says nothing, the
  /// curve is to get shorter (Volino, Magnenat-Thalmann 2006, "Resolving surface collisions through intersection
  /// contour minimization", section 3). From a solid whose edges pass through it cloth goes to the side where it is
  /// nearer.
  void Find(std::span<const Vec3> x, std::span<const std::uint8_t> free, std::vector<Tangle>& tangles) const;

 private:
  /// The curve along which two cloths meet, as it lies in each of the two: each counts as a sheet. Named by numbers
  /// below twice that of all pairs.
  struct Sheets {
    std::int32_t edge = 0, triangle = 0;  // That of the edge of a pair, and of its triangle.
  };
  /// The sheets that a vertex lies near; -1 behind the last.
  using Near = std::array<std::int32_t, 4>;
  /// An edge and a triangle, where they meet.
  struct Meeting {
    std::array<std::int32_t, 2> edge;
    std::array<std::int32_t, 3> corner;
    Sheets sheets;
    std::array<double, 3> weight;   // Of the corners.
    Vector3<double> place, normal;  // The normal of the triangle.
    bool towards;                   // The edge goes where the normal points.
    std::int32_t pulled;            // The end of the edge that is.
    Vector3<double> way;            // Of the edge, the triangle the other.

    /// The end of the edge on a side of the triangle: 1 where its normal points, 0 the other.
    std::int32_t EndOn(int side) const { return edge[towards == (side == 1) ? 1 : 0]; }
  };

  std::span<const std::int32_t> TrianglesOf(std::int32_t vertex) const;
  template <class F>
  void ForTrianglesOf(std::int32_t from, std::int32_t to, const F& f) const;
  bool IsLone(const std::array<std::int32_t, 2>& edge) const;
  bool AreNeighbours(std::int32_t vertex, std::span<const std::int32_t> others, int edges) const;
  void FollowCurves();
  void MarkNear();
  std::vector<Meeting> Locate(std::span<const Vec3> x) const;
  Vector3<double> ShorterWay(const Meeting& meeting, std::span<const Vec3> x) const;
  Vector3<double> NormalAt(const std::array<std::int32_t, 2>& edge, std::span<const Vec3> x) const;
  std::vector<std::int64_t> WeighParts(std::span<const std::uint8_t> free, std::span<const Meeting> meetings) const;
  void SendPartsBack(std::span<const Vec3> x, std::span<const std::uint8_t> free, std::span<Meeting> meetings) const;
  void LeaveSolids(std::span<const Vec3> x, std::span<Meeting> meetings) const;

  const ContactMesh& mesh_;
  Lists triangles_;  // per vertex those that have it
  std::vector<Intersection> met_;
  std::vector<Sheets> sheets_;       // of each of these
  std::vector<std::int32_t> other_;  // per sheet
  std::vector<Near> near_;           // per vertex
};

}  // namespace percale
