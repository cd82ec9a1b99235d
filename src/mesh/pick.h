#pragma once
/// \file
/// What a ray meets first: which point of the cloth is under the pointer.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale {

struct Ray {
  Vec3 origin;     ///< [m]
  Vec3 direction;  ///< Of any length but 0.
};

/// Where a ray meets a surface.
struct Hit {
  std::int32_t triangle = 0;        ///< Its index.
  std::array<double, 3> weights{};  ///< Barycentric, of the triangle's vertices a, b, c: 0..1, their sum 1.
  std::int32_t vertex = 0;          ///< Of the three, the one nearest to the point.
  Vec3 point;                       ///< [m]
  double distance = 0;              ///< From the ray's origin [m], >= 0.
};

/// The nearest triangle that the ray meets, from either side; of several at the same distance the first.
/// A ray through an edge or a vertex that triangles share does not slip between them. Triangles without
/// area or with positions that are no numbers are not met.
std::optional<Hit> PickCloth(const Ray& ray, std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace percale
