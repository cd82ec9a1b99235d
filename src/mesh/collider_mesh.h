#pragma once
/// \file
/// Meshes as colliders: which side of them is outside.

#include "percale/diagnostic.h"
#include "percale/rest_mesh.h"
#include "percale/scene.h"

namespace percale {

/// How the settings want their mesh read: seams closed, for what is solid has none.
MeshOptions MeshOptionsOf(const ColliderSettings& settings);

/// Whether the collider is a mesh that it does not hold with these settings.
bool LacksMesh(const ColliderSettings& settings);

/// Turns closed pieces over that are inside out, unless their box lies within that of another: then they may be the
/// wall of a hollow. The triangles of a piece must face like their neighbours. Warns of what it turned, the warnings
/// without a place.
Diagnostics TurnOutwards(RestMesh& mesh);

/// Warns, without a place, of a cache for that mesh whose edges are of another size than the mesh's, as those of
/// another vertex order are, and of closed pieces that it turns inside out. The mesh is turned outwards.
Diagnostics FindCacheProblems(const RestMesh& mesh, const VertexCache& cache, double scale);

/// How many edges have one triangle only: 0 of a closed mesh.
int CountOpenEdges(const RestMesh& mesh);

}  // namespace percale
