#pragma once
/// \file
/// What can be wrong with a mesh, in words, and the cure where there is one.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/rest_mesh.h"

namespace percale {

/// Coordinates end here [m], as those of scenes do.
inline constexpr double kFarthestVertex = 1e6;
/// A triangle that is lower than this, measured against its longest side, counts as without area.
inline constexpr double kThinnestTriangle = 1e-6;

/// Lists of triangles, vertices or edges, each ascending.
struct MeshProblems {
  // Errors: the mesh cannot be simulated.
  std::vector<std::int32_t> badIndex;        ///< Triangles with a vertex that does not exist.
  std::vector<std::int32_t> repeatedVertex;  ///< Triangles with a vertex twice.
  std::vector<std::int32_t> badPosition;     ///< Vertices with NaN, infinity or beyond kFarthestVertex.
  std::vector<std::int32_t> badMaterial;     ///< Triangles with such a corner in the fabric.
  std::vector<std::int32_t> noArea;          ///< Triangles without area in the fabric.

  // Warnings: RepairMesh takes care of them.
  std::vector<std::int32_t> duplicates;    ///< Triangles with the vertices of one before.
  std::vector<std::int32_t> unreferenced;  ///< Vertices of no triangle.
  std::vector<std::int32_t> turned;    ///< Triangles that run an edge the way their neighbour does, and can be turned.
  std::vector<std::int32_t> mirrored;  ///< Triangles that are clockwise in the fabric.

  // Warnings: the mesh can be simulated as it is.
  std::vector<std::int32_t> folded;    ///< Triangles that the texture lays over a neighbour in their panel; of the two
                                       ///< the one that is clockwise there.
  std::vector<Edge> nonManifold;       ///< Edges of more than two triangles, which will not resist folding.
  std::vector<std::int32_t> oneSided;  ///< The lowest triangle of each patch with one side, such as a Moebius strip.

  bool HasErrors() const {
    return !(badIndex.empty() && repeatedVertex.empty() && badPosition.empty() && badMaterial.empty() &&
             noArea.empty());
  }
};

/// Looks for all of them. The warnings are looked for where there are no errors; `folded` only with the texture that
/// the fabric was cut from, three coordinates per triangle. Takes about a second for a million triangles.
MeshProblems FindMeshProblems(const RestMesh& mesh, std::span<const Vec2> cornerUv = {});

/// One kind of problem in words.
struct MeshProblem {
  Severity severity = Severity::Error;
  std::string message;         ///< "3 triangles have no area in the fabric (5, 8 and 9, counted from 0); ..."
  std::int32_t triangle = -1;  ///< The first one that it is about, or -1.
};

/// Each kind of which there is one: how many, the first few, and the remedy.
std::vector<MeshProblem> DescribeMeshProblems(const MeshProblems& problems);

/// Where the vertices and triangles went: the new number of each old one, or -1.
struct MeshMap {
  std::vector<std::int32_t> vertices, triangles;
};

/// Drops duplicates and unreferenced vertices, turns triangles, and mirrors in the fabric what is clockwise there or
/// was turned (y becomes -y, which changes no length along warp or weft). Afterwards FindMeshProblems finds nothing of
/// these. `problems` must be those of `mesh`, without errors.
MeshMap RepairMesh(RestMesh& mesh, const MeshProblems& problems);

}  // namespace percale
