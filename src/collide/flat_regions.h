#pragma once
/// \file
/// Where a mesh lies so flat that no two of its items can touch unless they are neighbours.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "collide/kernels.h"

namespace percale {

/// Pairs of leaves of one body whose places, without one axis, are a plane triangulation that covers the convex hull of
/// both: the region of the pair.
///
/// Let F be a triangle's derivative of position by place, 3 x 2. If there is a G with (Gᵀ F + Fᵀ G) / 2 >= m for all
/// triangles of the region, then for two points of the leaves at positions x, y and places p, q, since p and q are
/// joined by a straight line through the region,
///   |G| |p - q| |x - y| >= (p - q)ᵀ Gᵀ (x - y) >= m |p - q|².
/// Items with no vertex in common are at least the least altitude h of the region's triangles apart in place, as what
/// starts at a vertex has to cross one of its triangles. So they are at least m h / |G| apart.
struct FlatRegions {
  /// Inverse of the edge vectors (b - a, c - a) in place, row by row [1/m]. Those of a leaf's triangles are from
  /// inverseFirst[leaf] on, in their order; leaves that are alike, as most of a regular grid are, share them.
  std::vector<std::array<float, 4>> inverse;
  std::vector<std::int32_t> inverseFirst;
  /// Per leaf: how fast F changes at most when vertices move, the greatest sum of a triangle's three inverse altitudes
  /// [1/m]; or -1: it has no regions.
  std::vector<float> greatestSlope;
  std::vector<std::int32_t> first;        ///< Leaf l has the pairs with others at [first[l], first[l + 1]) of ...
  std::vector<std::int32_t> other;        ///< ... these: ascending, itself and such that come behind it.
  std::vector<float> altitude;            ///< Per pair: h [m].
  std::vector<std::int32_t> regionFirst;  ///< Pair k has the leaves at [regionFirst[k], regionFirst[k + 1]) of ...
  std::vector<std::int32_t> region;       ///< ... these.
  std::vector<std::int32_t> aroundFirst;  ///< Leaf l has the leaves at [aroundFirst[l], aroundFirst[l + 1]) of ...
  std::vector<std::int32_t> around;       ///< ... these in the regions of its pairs.
  std::vector<float> aroundAltitude;      ///< Per leaf: the least of its pairs [m].

  /// Whether `AreApart` holds for all pairs of the leaf, as far as a quicker test tells.
  bool AreAllApart(std::int32_t leaf, std::span<const collide::LeafShape> shapes, float distance) const;

  /// The number of the pair, or -1.
  std::int32_t Find(std::int32_t a, std::int32_t b) const;
  /// Whether no two items of the pair's leaves a and b without a vertex in common come within that distance. `shapes`:
  /// per leaf; `trianglesOf(leaf)` is asked for where they do not tell.
  bool AreApart(std::int32_t pair, std::int32_t a, std::int32_t b, std::span<const collide::LeafShape> shapes,
                const std::function<const collide::TriangleShapes&(std::int32_t)>& trianglesOf,
                const collide::Kernels& kernels, float distance) const;
  std::size_t MemoryBytes() const;
};

/// The mesh has its clusters.
FlatRegions MakeFlatRegions(const ContactMesh& mesh);

}  // namespace percale
