#pragma once
/// \file
/// A cloth of any shape: where it starts, and what it is when nothing pulls at it.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale {

/// What a mesh is like when nothing pulls at it.
enum class RestShape {
  Space,    ///< As its vertices lie: the file shows the cloth at rest.
  Texture,  ///< As its texture coordinates lie: the file shows worn cloth, and its texture the flat panels.
};

/// How the file of a mesh is to be understood.
struct MeshOptions {
  double scale = 1;                         ///< Metres per unit of the file, > 0.
  RestShape rest = RestShape::Space;        ///< Where the rest shape comes from.
  double metresPerUv = 1;                   ///< Size of the texture, when it is the rest shape [m], > 0.
  std::optional<Vec3> warp = std::nullopt;  ///< Direction of the warp in space, of any length but 0, for triangles
                                            ///< without texture coordinates; without it, that of their first edge.
  bool weld = false;                        ///< Vertices that lie together become one, which closes seams.
  double weldDistance = 0;                  ///< Farthest that they lie apart [m]: 0, for the same place, or >= 1e-9.
  friend bool operator==(const MeshOptions&, const MeshOptions&) = default;
};

/// Vertices under one name, such as a sleeve or a waistband.
struct VertexGroup {
  std::string name;
  std::vector<std::int32_t> vertices;  ///< Ascending, each once.
  friend bool operator==(const VertexGroup&, const VertexGroup&) = default;
};

/// Triangles that are cut from flat fabric. The vertices say where the cloth starts; the corners say where in the
/// fabric each triangle was cut, which differs from triangle to triangle at a seam.
struct RestMesh {
  std::string name;                  ///< For messages: a file's stem, "grid", "disc".
  std::vector<Vec3> positions;       ///< Of the vertices at the start [m].
  std::vector<Triangle> triangles;   ///< Two that share an edge run it in opposite ways where the piece has two sides.
  std::vector<Vec2> material;        ///< Three per triangle, of its corners a, b, c in the flat fabric [m]: x along the
                                     ///< warp, y along the weft, the corners counter-clockwise. Where a triangle lies
                                     ///< in the plane does not matter, only its lengths and directions.
  std::vector<Vec2> uv;              ///< Texture coordinates of the vertices, for drawing.
  std::vector<VertexGroup> groups;   ///< In the order in which they were first named.
  std::vector<std::int32_t> source;  ///< Per vertex its number in the file, from 0 (the lowest of those that became
                                     ///< one); empty where it was not read from a file.
  std::int32_t sourceCount = 0;      ///< Of vertices in the file; 0 where it was not read from one.
  friend bool operator==(const RestMesh&, const RestMesh&) = default;
};

/// A mesh, and what it was read from.
struct LoadedMesh {
  std::string file;  ///< As the settings name it.
  MeshOptions options;
  RestMesh mesh;
  int openEdges = 0;  ///< Of a collider's mesh: edges of one triangle; 0: it is closed.
  friend bool operator==(const LoadedMesh&, const LoadedMesh&) = default;
};

}  // namespace percale
