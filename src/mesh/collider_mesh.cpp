#include "mesh/collider_mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/text.h"
#include "mesh/topology.h"

namespace percale {
namespace {

constexpr double kRounding = 1e-9;  // Generously, of a volume: 0.999999 is told as 1.

/// A volume below this share of the cube of the box's diagonal is none.
constexpr double kFlat = 1e-9;
/// Edges that are on the mean so many times longer or shorter are those of another mesh, or in another unit.
constexpr double kOtherSize = 3;

/// Triangles that hang together by their vertices.
struct Piece {
  bool open = false;
  double volume = 0;  ///< [m^3]; negative where the triangles face inwards.
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

  void Add(const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool Within(const Piece& other) const {
    return other.low.x < low.x && other.low.y < low.y && other.low.z < low.z && high.x < other.high.x &&
           high.y < other.high.y && high.z < other.high.z;
  }
};

/// `positions`: of the mesh's vertices.
std::vector<Piece> FindPieces(const RestMesh& mesh, const Topology& topology, std::span<const Vec3> positions) {
  std::vector<Piece> pieces(static_cast<std::size_t>(topology.componentCount));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (topology.component[v] >= 0) pieces[Index(topology.component[v])].Add(positions[v]);
  }
  for (const Triangle& t : mesh.triangles) {
    Piece& piece = pieces[Index(topology.component[Index(t.a)])];
    // Of the tetrahedra over the triangles with a tip near them, so that little is lost by rounding.
    const Vec3 a = positions[Index(t.a)] - piece.low, b = positions[Index(t.b)] - piece.low,
               c = positions[Index(t.c)] - piece.low;
    piece.volume += Dot(a, Cross(b, c)) / 6;
  }
  for (const std::vector<std::int32_t>* edges : {&topology.boundaryEdges, &topology.nonManifoldEdges}) {
    for (const std::int32_t e : *edges) {
      pieces[Index(topology.component[Index(topology.edges[Index(e)].a)])].open = true;
    }
  }
  return pieces;
}

double MeanEdge(const Topology& topology, std::span<const Vec3> positions) {
  double sum = 0;
  for (const Edge& e : topology.edges) sum += Length(positions[Index(e.b)] - positions[Index(e.a)]);
  return sum / static_cast<double>(std::max<std::size_t>(topology.edges.size(), 1));
}

}  // namespace

MeshOptions MeshOptionsOf(const ColliderSettings& settings) {
  MeshOptions options;
  options.scale = settings.meshScale;
  options.weld = true;
  return options;
}

bool LacksMesh(const ColliderSettings& settings) {
  if (settings.shape != ColliderShape::Mesh) return false;
  const LoadedMesh* const loaded = settings.loaded.get();
  return !loaded || loaded->file != settings.mesh || loaded->options != MeshOptionsOf(settings);
}

Diagnostics TurnOutwards(RestMesh& mesh) {
  const Topology topology = BuildTopology(mesh.positions.size(), mesh.triangles);
  const std::vector<Piece> pieces = FindPieces(mesh, topology, mesh.positions);
  std::vector<bool> turned(pieces.size());
  Diagnostics warnings;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Piece& piece = pieces[k];
    if (piece.open) continue;
    const Vec3 box = piece.high - piece.low;
    const std::string which = pieces.size() == 1 ? "the mesh" : "piece " + std::to_string(k) + " of the mesh";
    if (std::abs(piece.volume) <= kFlat * Dot(box, box) * Length(box)) {
      warnings.push_back(MakeWarning(which +
                                     " is flat: it is closed and has no volume, so it has no inside; leave one of "
                                     "its two sides out and set `two_sided` to true, or give it a thickness"));
      continue;
    }
    if (!(piece.volume < 0)) continue;
    if (std::any_of(pieces.begin(), pieces.end(), [&](const Piece& other) { return piece.Within(other); })) continue;
    turned[k] = true;
    warnings.push_back(MakeWarning(which + " is inside out: its volume is " +
                                   FormatNumber(-RoundDown(-piece.volume * (1 + kRounding), 3)) +
                                   " m^3; its triangles are turned over, to face outwards; do so in the file as well"));
  }
  if (warnings.empty()) return warnings;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle& triangle = mesh.triangles[t];
    if (!turned[Index(topology.component[Index(triangle.a)])]) continue;
    std::swap(triangle.b, triangle.c);
    std::swap(mesh.material[3 * t + 1], mesh.material[3 * t + 2]);
    for (std::size_t k = 0; k < 3; ++k) mesh.material[3 * t + k].y = -mesh.material[3 * t + k].y;
  }
  return warnings;
}

Diagnostics FindCacheProblems(const RestMesh& mesh, const VertexCache& cache, double scale) {
  const Topology topology = BuildTopology(mesh.positions.size(), mesh.triangles);
  const std::vector<Piece> pieces = FindPieces(mesh, topology, mesh.positions);
  const double restEdge = MeanEdge(topology, mesh.positions);
  std::vector<Vec3> positions(mesh.positions.size());
  bool otherSize = false, insideOut = false;
  Diagnostics warnings;
  for (std::int32_t s = 0; s < cache.samples; ++s) {
    const float* x = cache.positions.data() + 3 * positions.size() * Index(s);
    for (Vec3& position : positions) {
      position = Vec3{double(x[0]), double(x[1]), double(x[2])} * scale;
      x += 3;
    }
    const double ratio = MeanEdge(topology, positions) / restEdge;
    if (!otherSize && !(ratio < kOtherSize && ratio * kOtherSize > 1)) {
      otherSize = true;
      warnings.push_back(
          MakeWarning("sample " + std::to_string(s) + ": edges of the mesh are " + FormatNumber(RoundDown(ratio, 3)) +
                      " times as long as in its file; export both in the same unit, with the vertices in "
                      "the same order"));
    }
    const std::vector<Piece> now = FindPieces(mesh, topology, positions);
    for (std::size_t k = 0; k < pieces.size() && !insideOut; ++k) {
      if (pieces[k].open || !(pieces[k].volume > 0) || now[k].volume > 0) continue;
      insideOut = true;
      warnings.push_back(MakeWarning("sample " + std::to_string(s) + ": " +
                                     (pieces.size() == 1 ? "the mesh" : "piece " + std::to_string(k) + " of the mesh") +
                                     " is inside out: its volume is " +
                                     FormatNumber(-RoundDown(-now[k].volume * (1 + kRounding), 3)) +
                                     " m^3; what is mirrored or crushed flat cannot hold cloth outside"));
    }
  }
  return warnings;
}

int CountOpenEdges(const RestMesh& mesh) {
  return static_cast<int>(BuildTopology(mesh.positions.size(), mesh.triangles).boundaryEdges.size());
}

}  // namespace percale
