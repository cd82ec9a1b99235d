#pragma once
/// \file
/// Vertices of a mesh that move: where each is at even times, such as those of a body that walks.

#include <cstdint>
#include <string>
#include <vector>

namespace percale {

/// A vertex cache, read for one mesh.
struct VertexCache {
  std::string file;              ///< As the settings name it.
  double spacing = 0;            ///< From sample to sample, as the file states it, >= 0; see SampleSeconds.
  std::int32_t samples = 0;      ///< >= 1.
  float greatestMove = 0;        ///< Of a vertex from one sample to the next, in the mesh's unit.
  std::vector<float> positions;  ///< x, y, z of each vertex of the mesh, sample after sample, in the mesh's unit.
  bool inSeconds = false;        ///< `spacing` is in seconds, however long.
  friend bool operator==(const VertexCache&, const VertexCache&) = default;
};

}  // namespace percale
