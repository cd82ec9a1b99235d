#include "mesh/mesh_problems.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "core/index.h"
#include "mesh/rest_mesh.h"
#include "mesh/topology.h"

namespace percale {
namespace {

/// So many are named in a message.
constexpr std::size_t kNamed = 5;

bool Within(double x) {
  return std::abs(x) <= kFarthestVertex;  // false for NaN
}

/// Triangles with the same three vertices as one before, whatever their order; ascending.
std::vector<std::int32_t> FindDuplicates(std::size_t vertexCount, std::span<const Triangle> triangles) {
  struct Rest {
    std::int32_t middle, high, triangle;
  };
  // By the lowest vertex first, which takes one pass; then the few that share it by the others.
  std::vector<std::int32_t> begin(vertexCount + 1, 0);
  for (const Triangle& t : triangles) ++begin[Index(std::min({t.a, t.b, t.c})) + 1];
  for (std::size_t v = 0; v < vertexCount; ++v) begin[v + 1] += begin[v];
  std::vector<Rest> sorted(triangles.size());
  std::vector<std::int32_t> end(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const std::int32_t low = std::min({t.a, t.b, t.c}), high = std::max({t.a, t.b, t.c});
    const std::int32_t middle = std::max(std::min(t.a, t.b), std::min(std::max(t.a, t.b), t.c));
    sorted[Index(end[Index(low)]++)] = {middle, high, static_cast<std::int32_t>(i)};
  }
  std::vector<std::int32_t> duplicates;
  for (std::size_t v = 0; v < vertexCount; ++v) {
    const auto first = sorted.begin() + begin[v], last = sorted.begin() + begin[v + 1];
    std::sort(first, last, [](const Rest& a, const Rest& b) {
      if (a.middle != b.middle) return a.middle < b.middle;
      return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
    });
    for (auto r = first; r != last; ++r) {
      if (r != first && r->middle == (r - 1)->middle && r->high == (r - 1)->high) duplicates.push_back(r->triangle);
    }
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

bool HasArea(std::span<const Vec2> material, std::size_t t) {
  double longest = 0;  // squared
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 &a = material[3 * t + k], &b = material[3 * t + (k + 1) % 3];
    longest = std::max(longest, (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
  }
  return 2 * std::abs(MaterialArea(material, t)) > kThinnestTriangle * longest;
}

void FindErrors(const RestMesh& mesh, MeshProblems& problems) {
  const std::size_t vertexCount = mesh.positions.size();
  for (std::size_t v = 0; v < vertexCount; ++v) {
    const Vec3& p = mesh.positions[v];
    if (!Within(p.x) || !Within(p.y) || !Within(p.z)) problems.badPosition.push_back(static_cast<std::int32_t>(v));
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const auto number = static_cast<std::int32_t>(i);
    if (std::min({t.a, t.b, t.c}) < 0 || Index(std::max({t.a, t.b, t.c})) >= vertexCount) {
      problems.badIndex.push_back(number);
    } else if (t.a == t.b || t.b == t.c || t.c == t.a) {
      problems.repeatedVertex.push_back(number);
    } else {
      const std::span<const Vec2> corners(&mesh.material[3 * i], 3);
      const bool good =
          std::all_of(corners.begin(), corners.end(), [](const Vec2& p) { return Within(p.x) && Within(p.y); });
      if (!good)
        problems.badMaterial.push_back(number);
      else if (!HasArea(mesh.material, i))
        problems.noArea.push_back(number);
    }
  }
}

std::string Few(std::size_t count, const auto& name) {
  std::string out = "(";
  const std::size_t named = std::min(count, kNamed), more = count - named;
  for (std::size_t i = 0; i < named; ++i) {
    if (i > 0) out += i + 1 == named && more == 0 ? " and " : ", ";
    out += name(i);
  }
  if (more > 0) out += " and " + std::to_string(more) + " more";
  return out + ", counted from 0)";
}
std::string Few(const std::vector<std::int32_t>& ids) {
  return Few(ids.size(), [&](std::size_t i) { return std::to_string(ids[i]); });
}

/// "1 triangle has" or "3 triangles have".
std::string Count(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

void DropEntries(auto& values, const std::vector<std::int32_t>& map) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] >= 0) values[kept++] = values[i];
  }
  values.resize(kept);
}

/// The new numbers of `count` things of which those of `dropped`, ascending, go.
std::vector<std::int32_t> Renumbered(std::size_t count, const std::vector<std::int32_t>& dropped) {
  std::vector<std::int32_t> map(count);
  std::int32_t next = 0;
  auto drop = dropped.begin();
  for (std::size_t i = 0; i < count; ++i) {
    const bool goes = drop != dropped.end() && Index(*drop) == i;
    if (goes) ++drop;
    map[i] = goes ? -1 : next++;
  }
  return map;
}

/// Mirrors a triangle in the fabric.
void Mirror(RestMesh& mesh, std::int32_t t) {
  for (std::size_t k = 0; k < 3; ++k) mesh.material[3 * Index(t) + k].y = -mesh.material[3 * Index(t) + k].y;
}

/// Triangles that lie on the same side of an edge as their neighbour in the texture, though both have the edge at the
/// same place there; `old` is the number of each in `cornerUv`.
std::vector<std::int32_t> FindFolded(const Topology& topology, std::span<const Triangle> triangles,
                                     std::span<const std::int32_t> old, std::span<const Vec2> cornerUv) {
  const auto uvOf = [&](std::int32_t triangle, std::int32_t vertex) {
    const Triangle& t = triangles[Index(triangle)];
    return cornerUv[3 * Index(old[Index(triangle)]) + (t.a == vertex ? 0 : t.b == vertex ? 1 : 2)];
  };
  std::vector<std::int32_t> folded;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const auto& [t0, t1] = topology.edgeTriangles[e];
    if (t0 < 0 || t1 < 0) continue;
    const Edge& edge = topology.edges[e];
    const Vec2 a = uvOf(t0, edge.a), b = uvOf(t0, edge.b);
    if (!(a == uvOf(t1, edge.a) && b == uvOf(t1, edge.b))) continue;  // a seam
    const auto side = [&](const Vec2& p) { return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x); };
    const auto& [apex0, apex1] = topology.edgeOpposite[e];
    if (!(side(uvOf(t0, apex0)) * side(uvOf(t1, apex1)) > 0)) continue;
    folded.push_back(MaterialArea(cornerUv, Index(old[Index(t0)])) < 0 ? old[Index(t0)] : old[Index(t1)]);
  }
  std::sort(folded.begin(), folded.end());
  folded.erase(std::unique(folded.begin(), folded.end()), folded.end());
  return folded;
}

}  // namespace

MeshProblems FindMeshProblems(const RestMesh& mesh, std::span<const Vec2> cornerUv) {
  assert(mesh.material.size() == 3 * mesh.triangles.size());
  MeshProblems problems;
  FindErrors(mesh, problems);
  if (problems.HasErrors()) return problems;

  // Duplicates would make their edges look non-manifold, so the rest is about the mesh without them.
  problems.duplicates = FindDuplicates(mesh.positions.size(), mesh.triangles);
  const std::vector<std::int32_t> map = Renumbered(mesh.triangles.size(), problems.duplicates);
  std::vector<Triangle> triangles = mesh.triangles;
  DropEntries(triangles, map);
  std::vector<std::int32_t> old;
  old.reserve(triangles.size());
  for (std::size_t t = 0; t < map.size(); ++t) {
    if (map[t] >= 0) old.push_back(static_cast<std::int32_t>(t));
  }

  const Topology topology = BuildTopology(mesh.positions.size(), triangles);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (topology.component[v] < 0) problems.unreferenced.push_back(static_cast<std::int32_t>(v));
  }
  for (const std::int32_t edge : topology.nonManifoldEdges) problems.nonManifold.push_back(topology.edges[Index(edge)]);
  const TurnedTriangles orientation = FindOrientation(topology);
  for (const std::int32_t t : orientation.turn) problems.turned.push_back(old[Index(t)]);
  for (const std::int32_t t : orientation.oneSided) problems.oneSided.push_back(old[Index(t)]);
  for (const std::int32_t t : old) {
    if (MaterialArea(mesh.material, Index(t)) < 0) problems.mirrored.push_back(t);
  }
  if (!cornerUv.empty()) problems.folded = FindFolded(topology, triangles, old, cornerUv);
  return problems;
}

std::vector<MeshProblem> DescribeMeshProblems(const MeshProblems& problems) {
  std::vector<MeshProblem> found;
  const auto about = [&](Severity severity, const std::vector<std::int32_t>& triangles, const char* one,
                         const char* many, const std::string& remedy) {
    if (triangles.empty()) return;
    found.push_back(
        {severity, Count(triangles.size(), one, many) + " " + Few(triangles) + "; " + remedy, triangles.front()});
  };
  about(Severity::Error, problems.badIndex, "triangle names a vertex that does not exist",
        "triangles name vertices that do not exist", "expected the numbers of vertices of the mesh");
  about(Severity::Error, problems.repeatedVertex, "triangle has the same vertex twice",
        "triangles have the same vertex twice", "expected three different ones; remove such triangles");
  if (!problems.badPosition.empty()) {
    found.push_back({Severity::Error,
                     Count(problems.badPosition.size(), "vertex is", "vertices are") +
                         " not a place within 1000 km of the origin " + Few(problems.badPosition) +
                         "; expected finite coordinates in metres",
                     -1});
  }
  about(Severity::Error, problems.badMaterial, "triangle has no finite place within 1000 km in the fabric",
        "triangles have no finite place within 1000 km in the fabric",
        "give each corner texture coordinates, or take the rest shape from the positions");
  about(Severity::Error, problems.noArea, "triangle has no area at rest", "triangles have no area at rest",
        "expected a height above a millionth of the longest side; merge vertices that coincide, or remove such "
        "triangles");
  about(Severity::Warning, problems.duplicates, "triangle has the vertices of another",
        "triangles have the vertices of others", "the later ones are dropped");
  if (!problems.unreferenced.empty()) {
    found.push_back({Severity::Warning,
                     Count(problems.unreferenced.size(), "vertex belongs", "vertices belong") + " to no triangle " +
                         Few(problems.unreferenced) + "; dropped",
                     -1});
  }
  about(Severity::Warning, problems.turned, "triangle faces the other way than its neighbours",
        "triangles face the other way than their neighbours", "turned over");
  about(Severity::Warning, problems.mirrored, "triangle is clockwise in the fabric",
        "triangles are clockwise in the fabric", "mirrored there");
  about(Severity::Warning, problems.folded, "triangle lies over its neighbour in the texture",
        "triangles lie over their neighbours in the texture",
        "their fabric is taken as if unfolded; mend the texture coordinates if that was not meant");
  if (!problems.nonManifold.empty()) {
    const auto name = [&](std::size_t i) {
      return std::to_string(problems.nonManifold[i].a) + "-" + std::to_string(problems.nonManifold[i].b);
    };
    found.push_back({Severity::Warning,
                     Count(problems.nonManifold.size(), "edge has", "edges have") + " more than two triangles " +
                         Few(problems.nonManifold.size(), name) + "; the cloth does not resist folding there",
                     -1});
  }
  about(Severity::Warning, problems.oneSided, "piece has one side only, as a Moebius strip has",
        "pieces have one side only, as a Moebius strip has", "front and back change over along a seam of it");
  return found;
}

MeshMap RepairMesh(RestMesh& mesh, const MeshProblems& problems) {
  assert(!problems.HasErrors());
  for (const std::int32_t t : problems.turned) {
    std::swap(mesh.triangles[Index(t)].b, mesh.triangles[Index(t)].c);
    std::swap(mesh.material[3 * Index(t) + 1], mesh.material[3 * Index(t) + 2]);
    Mirror(mesh, t);  // or turning would have made it clockwise
  }
  for (const std::int32_t t : problems.mirrored) Mirror(mesh, t);

  MeshMap map{Renumbered(mesh.positions.size(), problems.unreferenced),
              Renumbered(mesh.triangles.size(), problems.duplicates)};
  if (!problems.duplicates.empty()) {
    for (std::size_t t = 0; t < map.triangles.size(); ++t) {
      if (map.triangles[t] < 0) continue;
      for (std::size_t k = 0; k < 3; ++k) mesh.material[3 * Index(map.triangles[t]) + k] = mesh.material[3 * t + k];
    }
    DropEntries(mesh.triangles, map.triangles);
    mesh.material.resize(3 * mesh.triangles.size());
  }
  if (!problems.unreferenced.empty()) {
    DropEntries(mesh.positions, map.vertices);
    DropEntries(mesh.uv, map.vertices);
    DropEntries(mesh.source, map.vertices);
    for (Triangle& t : mesh.triangles)
      t = {map.vertices[Index(t.a)], map.vertices[Index(t.b)], map.vertices[Index(t.c)]};
    for (VertexGroup& group : mesh.groups) {
      std::vector<std::int32_t> kept;
      for (const std::int32_t v : group.vertices) {
        if (map.vertices[Index(v)] >= 0) kept.push_back(map.vertices[Index(v)]);
      }
      group.vertices = std::move(kept);
    }
  }
  return map;
}

}  // namespace percale
