#pragma once
/// \file
/// Which way cloth that is tangled comes apart.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/intersections.h"
#include "math/vector3.h"
#include "percale/vec3.h"

namespace percale {

/// An edge that passes through a triangle, and where it has to go.
struct Tangle {
  std::int32_t vertex = 0;               ///< The end of the edge that is nearer to the triangle.
  std::array<std::int32_t, 3> corner{};  ///< Of the triangle.
  std::array<double, 3> weight{};        ///< Of its corners, where they meet.
  Vector3<double> direction;             ///< Of length 1: that way the vertex, and the triangle the other.
};

class Untangler {
 public:
  /// The mesh must outlive it.
  explicit Untangler(const ContactMesh& mesh);

  /// For each of `met` the way along which the curve where the meshes meet gets shorter the fastest; none where that
  /// does not change, as in the middle of two sheets that cross. `x`: positions. `tangles` is replaced. (Volino,
  /// Magnenat-Thalmann 2006, "Resolving surface collisions through intersection contour minimization", section 3.)
  void Find(std::span<const Intersection> met, std::span<const Vec3> x, std::vector<Tangle>& tangles) const;

 private:
  Vector3<double> WayOf(const Intersection& meeting, std::span<const Vec3> x, const Vector3<double>& normal,
                        const Vector3<double>& place) const;

  const ContactMesh& mesh_;
  std::vector<std::int32_t> first_, triangle_;  // per vertex the triangles that have it
};

}  // namespace percale
