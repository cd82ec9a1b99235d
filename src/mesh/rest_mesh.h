#pragma once
/// \file
/// Makes rest meshes: simple shapes, and the flat fabric of a shape in space.

#include <optional>
#include <span>
#include <vector>

#include "percale/rest_mesh.h"
#include "percale/scene.h"

namespace percale {

/// The grid of MakeGrid: the same vertices, triangles and texture coordinates. Grid point (i, j) lies in the fabric at
/// (i * spacing, height - j * spacing), which makes the triangles counter-clockwise. `settings` must be valid.
RestMesh MakeGridMesh(const ClothSettings& settings);

/// A disc in the plane y = 0 around the origin, its upper side up: a vertex in the middle and 6 k on ring k at radius
/// k / rings of `radius` [m, > 0]; 6 rings^2 triangles, rings >= 1. In the fabric, x runs along x and y along -z.
RestMesh MakeDisc(double radius, int rings);

/// The cloth of the settings, placed: a grid, a disc, or the mesh that they hold.
RestMesh MakeClothMesh(const ClothSettings& settings);

/// Fabric coordinates of triangles that are at rest in space, three per triangle: each laid into its own plane with its
/// first corner at the origin. The warp runs in the direction in which the first texture coordinate grows and the
/// second stays; where these are missing or have no area, along `warp` projected into the triangle; where there is none
/// or it stands upright, along the triangle's edge from a to b. That last one differs from triangle to triangle and
/// suits only fabrics that are alike in all directions.
/// `cornerUv` has three entries per triangle or none; NaN means missing. A triangle without area gets three zeros.
std::vector<Vec2> MaterialFromShape(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                    std::span<const Vec2> cornerUv, const std::optional<Vec3>& warp);

/// Fabric coordinates from texture coordinates, three per triangle: `metresPerUv` [m, > 0] times as large. Triangles
/// that are clockwise there are mirrored, y becoming -y.
std::vector<Vec2> MaterialFromUv(std::span<const Vec2> cornerUv, double metresPerUv);

/// Area of the triangle `triangle` in the fabric [m^2]; negative where it is clockwise.
double MaterialArea(std::span<const Vec2> material, std::size_t triangle);

/// Texture coordinates for vertices that have none: seen along the shortest side of their box, the longest side 0..1.
std::vector<Vec2> ProjectedUv(std::span<const Vec3> positions);

}  // namespace percale
