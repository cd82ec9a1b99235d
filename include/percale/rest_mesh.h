#pragma once
/// \file
/// A cloth of any shape: where it starts, and what it is when nothing pulls at it.

#include <cstdint>
#include <string>
#include <vector>

#include "percale/mesh.h"
#include "percale/vec3.h"

namespace percale {

/// Vertices under one name, such as a sleeve or a waistband.
struct VertexGroup {
  std::string name;
  std::vector<std::int32_t> vertices;  ///< Ascending, each once.
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
};

}  // namespace percale
