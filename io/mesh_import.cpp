// LoadMesh: from the polygons of a file to a mesh that can be simulated.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "core/index.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/mesh_source.h"
#include "mesh/mesh_problems.h"
#include "mesh/rest_mesh.h"
#include "percale/mesh_file.h"

namespace percale {
namespace {

namespace fs = std::filesystem;

std::string Count(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Triangles and where each came from.
struct Triangles {
  std::vector<Triangle> triangles;
  std::vector<Vec2> cornerUv;        ///< Three per triangle, NaN where missing; empty where all are.
  std::vector<std::size_t> polygon;  ///< Of each triangle.
};

// --- Polygons ---

/// Twice the vector area of a polygon (Newell).
Vec3 PolygonNormal(std::span<const Vec3> x) {
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) normal += Cross(x[i] - x[0], x[i + 1] - x[0]);
  return normal;
}

/// The least share that a triangle of the fan around corner `start` has in the polygon's area; negative where the fan
/// folds back.
double LeastOfFan(std::span<const Vec3> x, std::size_t start, const Vec3& normal) {
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = x.size();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec3 &a = x[start], &b = x[(start + i) % n], &c = x[(start + i + 1) % n];
    least = std::min(least, Dot(Cross(b - a, c - a), normal));
  }
  return least;
}

/// The first corner whose fan of triangles covers the polygon; where some would have no area, the best of those tried.
/// Nothing where every fan folds back. Of a long polygon not all corners are tried.
std::optional<std::size_t> FanStart(std::span<const Vec3> x) {
  constexpr std::size_t kMostSearched = 64;
  constexpr double kNone = 1e-9;
  if (x.size() <= 3) return 0;
  const Vec3 normal = PolygonNormal(x);
  const double enough = kNone * Dot(normal, normal);
  std::size_t best = 0;
  double bestLeast = LeastOfFan(x, 0, normal);
  const std::size_t last = x.size() == 4 ? 2 : std::min(x.size(), kMostSearched);
  for (std::size_t start = 1; start < last && !(bestLeast > enough); ++start) {
    const double least = LeastOfFan(x, start, normal);
    if (least > bestLeast) best = start, bestLeast = least;
  }
  if (bestLeast < -enough) return std::nullopt;
  return best;
}

Triangles CutPolygons(const PolygonSoup& soup, const MeshSource& source, MeshMessages& messages) {
  Triangles out;
  const bool hasUv =
      std::any_of(soup.cornerTexture.begin(), soup.cornerTexture.end(), [](std::int32_t t) { return t >= 0; });
  const std::size_t count = soup.corners.size() - 2 * soup.polygonEnds.size();
  out.triangles.reserve(count);
  out.polygon.reserve(count);
  if (hasUv) out.cornerUv.reserve(3 * count);
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  std::size_t folded = 0, firstFolded = 0;
  std::vector<std::size_t> ring;
  std::vector<Vec3> x;
  for (std::size_t p = 0; p < soup.polygonEnds.size(); ++p) {
    const std::size_t begin = soup.PolygonBegin(p);
    ring.resize(soup.polygonEnds[p] - begin);
    std::iota(ring.begin(), ring.end(), begin);
    // A corner twice in a row: some programs write triangles as quads. With less than three others it is an error.
    const auto same = [&](std::size_t c, std::size_t d) { return soup.corners[c] == soup.corners[d]; };
    if (ring.size() > 3) ring.erase(std::unique(ring.begin(), ring.end(), same), ring.end());
    if (ring.size() > 3 && same(ring.front(), ring.back())) ring.pop_back();
    if (ring.size() < 3) {
      ring.resize(3);
      std::iota(ring.begin(), ring.end(), begin);
    }
    const std::size_t n = ring.size();
    x.clear();
    for (const std::size_t c : ring) x.push_back(soup.positions[Index(soup.corners[c])]);
    const auto start = FanStart(x);
    if (!start && folded++ == 0) firstFolded = p;
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const std::size_t first = start.value_or(0);
      const std::size_t corners[3] = {ring[first], ring[(first + i) % n], ring[(first + i + 1) % n]};
      out.triangles.push_back({soup.corners[corners[0]], soup.corners[corners[1]], soup.corners[corners[2]]});
      out.polygon.push_back(p);
      if (!hasUv) continue;
      for (const std::size_t corner : corners) {
        const std::int32_t t = soup.cornerTexture[corner];
        out.cornerUv.push_back(t >= 0 ? soup.texture[Index(t)] : Vec2{kMissing, kMissing});
      }
    }
  }
  if (folded > 0) {
    const std::string message = Count(folded, "polygon is", "polygons are") +
                                " so concave that triangles from one corner fold back; triangulate before the export";
    const std::size_t place = soup.polygonPlaces[firstFolded];
    messages.Add(soup.binary ? source.AtByte(place, Severity::Warning, message)
                             : source.At(place, Severity::Warning, message));
  }
  return out;
}

// --- Welding ---

/// For each position the lowest vertex that it becomes one with: at most `distance` away, and itself not welded to
/// another, so that chains of near vertices do not collapse.
std::vector<std::int32_t> FindWelds(std::span<const Vec3> positions, double distance) {
  std::vector<std::int32_t> kept(positions.size());
  std::iota(kept.begin(), kept.end(), 0);
  if (distance == 0) {
    std::vector<std::int32_t> sorted = kept;
    const auto before = [&](std::int32_t i, std::int32_t j) {
      const Vec3 &a = positions[Index(i)], &b = positions[Index(j)];
      if (a.x != b.x) return a.x < b.x;
      if (a.y != b.y) return a.y < b.y;
      return a.z != b.z ? a.z < b.z : i < j;
    };
    std::sort(sorted.begin(), sorted.end(), before);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      const std::int32_t lower = kept[Index(sorted[i - 1])];
      if (positions[Index(lower)] == positions[Index(sorted[i])]) kept[Index(sorted[i])] = lower;
    }
    return kept;
  }

  // Cells as wide as the distance, sorted; the vertices that stay are chained within each, few since they keep apart.
  using Cell = std::array<std::int64_t, 3>;
  const auto cellOf = [&](const Vec3& p) {
    const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / distance)); };
    return Cell{index(p.x), index(p.y), index(p.z)};
  };
  std::vector<Cell> cells;
  cells.reserve(positions.size());
  for (const Vec3& p : positions) cells.push_back(cellOf(p));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::vector<std::int32_t> head(cells.size(), -1), next(positions.size(), -1);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Cell own = cellOf(positions[v]);
    std::int32_t found = -1;
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const Cell first{own[0] + dx, own[1] + dy, own[2] - 1}, last{own[0] + dx, own[1] + dy, own[2] + 1};
        for (auto cell = std::lower_bound(cells.begin(), cells.end(), first); cell != cells.end() && *cell <= last;
             ++cell) {
          for (std::int32_t o = head[static_cast<std::size_t>(cell - cells.begin())]; o >= 0; o = next[Index(o)]) {
            const bool near = Length(positions[Index(o)] - positions[v]) <= distance;
            if (near && (found < 0 || o < found)) found = o;
          }
        }
      }
    }
    if (found >= 0) {
      kept[v] = found;
      continue;
    }
    auto& chain = head[static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), own) - cells.begin())];
    next[v] = chain;
    chain = static_cast<std::int32_t>(v);
  }
  return kept;
}

/// Renames the vertices of the triangles to those that stay. Triangles of which two corners became one go.
void Weld(std::span<const std::int32_t> kept, Triangles& mesh, std::size_t& dropped, std::size_t& firstDropped) {
  std::size_t next = 0;
  dropped = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle old = mesh.triangles[i], t{kept[Index(old.a)], kept[Index(old.b)], kept[Index(old.c)]};
    const bool wasWhole = old.a != old.b && old.b != old.c && old.c != old.a;
    if (wasWhole && (t.a == t.b || t.b == t.c || t.c == t.a)) {
      if (dropped++ == 0) firstDropped = mesh.polygon[i];
      continue;
    }
    mesh.triangles[next] = t;
    mesh.polygon[next] = mesh.polygon[i];
    for (std::size_t k = 0; k < 3 && !mesh.cornerUv.empty(); ++k)
      mesh.cornerUv[3 * next + k] = mesh.cornerUv[3 * i + k];
    ++next;
  }
  mesh.triangles.resize(next);
  mesh.polygon.resize(next);
  if (!mesh.cornerUv.empty()) mesh.cornerUv.resize(3 * next);
}

// --- The mesh ---

std::vector<VertexGroup> VertexGroups(const PolygonSoup& soup, std::span<const std::int32_t> kept) {
  std::vector<VertexGroup> groups;
  for (const PolygonSoup::Group& group : soup.groups) {
    VertexGroup out{group.name, {}};
    for (const auto& [first, end] : group.polygons) {
      for (std::size_t c = soup.PolygonBegin(first); c < soup.polygonEnds[end - 1]; ++c)
        out.vertices.push_back(kept[Index(soup.corners[c])]);
    }
    std::sort(out.vertices.begin(), out.vertices.end());
    out.vertices.erase(std::unique(out.vertices.begin(), out.vertices.end()), out.vertices.end());
    groups.push_back(std::move(out));
  }
  return groups;
}

/// Of each vertex the texture coordinates of its first corner that has some.
std::vector<Vec2> VertexUv(std::size_t vertexCount, const Triangles& mesh) {
  std::vector<Vec2> uv(vertexCount);
  std::vector<bool> has(vertexCount);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::int32_t corners[3] = {mesh.triangles[t].a, mesh.triangles[t].b, mesh.triangles[t].c};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& here = mesh.cornerUv[3 * t + k];
      if (has[Index(corners[k])] || std::isnan(here.x)) continue;
      uv[Index(corners[k])] = here;
      has[Index(corners[k])] = true;
    }
  }
  return uv;
}

std::optional<Diagnostic> CheckOptions(const std::string& file, const MeshOptions& options) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (!positive(options.scale)) return MakeError(file, "expected a scale > 0 m, got " + FormatNumber(options.scale));
  if (!positive(options.metresPerUv))
    return MakeError(file, "expected a size of the texture > 0 m, got " + FormatNumber(options.metresPerUv));
  if (options.weldDistance != 0 && !(options.weldDistance >= 1e-9 && std::isfinite(options.weldDistance))) {
    return MakeError(
        file, "expected a distance for welding of 0 or at least 1e-9 m, got " + FormatNumber(options.weldDistance));
  }
  if (options.warp && !(IsFinite(*options.warp) && positive(Length(*options.warp)))) {
    return MakeError(file, "expected a direction of the warp with a length, got (" + FormatNumber(options.warp->x) +
                               ", " + FormatNumber(options.warp->y) + ", " + FormatNumber(options.warp->z) + ")");
  }
  return std::nullopt;
}

/// From polygons to a mesh; errors go to `messages`.
class Importer {
 public:
  Importer(const MeshSource& source, const PolygonSoup& soup, const MeshOptions& options, MeshMessages& messages)
      : source_(source), soup_(soup), options_(options), messages_(messages) {}

  RestMesh Make() {
    Triangles cut = CutPolygons(soup_, source_, messages_);
    std::vector<std::int32_t> kept(soup_.positions.size());
    std::iota(kept.begin(), kept.end(), 0);
    if (options_.weld) {
      kept = FindWelds(soup_.positions, options_.weldDistance);
      std::size_t dropped = 0, first = 0;
      Weld(kept, cut, dropped, first);
      if (dropped > 0) {
        About(first, Severity::Warning,
              Count(dropped, "triangle is", "triangles are") + " dropped, whose corners became one by welding");
      }
    }
    RestMesh mesh;
    mesh.positions = soup_.positions;
    mesh.groups = VertexGroups(soup_, kept);
    mesh.source.resize(mesh.positions.size());
    std::iota(mesh.source.begin(), mesh.source.end(), 0);
    mesh.sourceCount = static_cast<std::int32_t>(mesh.positions.size());
    if (cut.triangles.empty()) {
      messages_.Add(MakeError(source_.file(), "no triangle is left after welding; lower the distance " +
                                                  FormatNumber(options_.weldDistance) + " m"));
      return mesh;
    }
    if (!MakeMaterial(mesh, cut)) return mesh;
    mesh.uv = cut.cornerUv.empty() ? ProjectedUv(mesh.positions) : VertexUv(mesh.positions.size(), cut);
    mesh.triangles = std::move(cut.triangles);
    Repair(mesh, cut, kept);
    return mesh;
  }

 private:
  void About(std::size_t polygon, Severity severity, const std::string& message) {
    const std::size_t place = soup_.polygonPlaces[polygon];
    messages_.Add(soup_.binary ? source_.AtByte(place, severity, message) : source_.At(place, severity, message));
  }

  bool MakeMaterial(RestMesh& mesh, const Triangles& cut) {
    if (options_.rest == RestShape::Space) {
      mesh.material = MaterialFromShape(mesh.positions, cut.triangles, cut.cornerUv, options_.warp);
      return true;
    }
    const char* const remedy = "; export it with texture coordinates, or take the rest shape from the positions";
    if (cut.cornerUv.empty()) {
      messages_.Add(
          MakeError(source_.file(), std::string("expected texture coordinates for the rest shape, got none") + remedy));
      return false;
    }
    for (std::size_t c = 0; c < cut.cornerUv.size(); ++c) {
      if (!std::isnan(cut.cornerUv[c].x)) continue;
      About(
          cut.polygon[c / 3], Severity::Error,
          std::string("expected texture coordinates at each corner for the rest shape, this face lacks some") + remedy);
      return false;
    }
    mesh.material = MaterialFromUv(cut.cornerUv, options_.metresPerUv);
    CompareAreas(mesh, cut.triangles);
    return true;
  }

  /// A texture of the wrong size shows in the area.
  void CompareAreas(const RestMesh& mesh, const std::vector<Triangle>& triangles) {
    constexpr double kFarApart = 4;
    double flat = 0, worn = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Triangle& t = triangles[i];
      const Vec3& a = mesh.positions[Index(t.a)];
      flat += MaterialArea(mesh.material, i);
      worn += Length(Cross(mesh.positions[Index(t.b)] - a, mesh.positions[Index(t.c)] - a)) / 2;
    }
    if (!(flat > 0) || !(worn > 0) || (flat < kFarApart * worn && worn < kFarApart * flat)) return;
    const auto rounded = [](double x) { return FormatNumber(RoundDown(x, 3)); };
    messages_.Add(MakeWarning(source_.file(), "the texture's panels have " + rounded(flat) +
                                                  " m^2, the mesh in space " + rounded(worn) + " m^2; " +
                                                  rounded(options_.metresPerUv * std::sqrt(worn / flat)) +
                                                  " m per unit of the texture would make them equal"));
  }

  void Repair(RestMesh& mesh, const Triangles& cut, std::span<const std::int32_t> kept) {
    const bool flat = options_.rest == RestShape::Texture;
    MeshProblems problems =
        FindMeshProblems(mesh, flat ? std::span<const Vec2>(cut.cornerUv) : std::span<const Vec2>());
    // Those that were welded to others are no surprise.
    std::vector<std::int32_t> lone;
    for (const std::int32_t v : problems.unreferenced) {
      if (kept[Index(v)] == v) lone.push_back(v);
    }
    std::vector<std::int32_t> unreferenced = std::move(problems.unreferenced);
    problems.unreferenced = std::move(lone);
    for (const MeshProblem& problem : DescribeMeshProblems(problems)) {
      if (problem.triangle >= 0)
        About(cut.polygon[Index(problem.triangle)], problem.severity, problem.message);
      else
        messages_.Add({problem.severity, {source_.file(), 0, 0}, problem.message, {}, 0});
    }
    problems.unreferenced = std::move(unreferenced);
    if (!problems.HasErrors()) RepairMesh(mesh, problems);
  }

  const MeshSource& source_;
  const PolygonSoup& soup_;
  const MeshOptions& options_;
  MeshMessages& messages_;
};

}  // namespace

std::vector<Triangle> TrianglesOf(const PolygonSoup& soup, const MeshSource& source, MeshMessages& messages) {
  return CutPolygons(soup, source, messages).triangles;
}

Result<RestMesh> LoadMesh(const fs::path& file, const MeshOptions& options) {
  if (auto problem = CheckOptions(PathText(file), options)) return *problem;
  auto source = MeshSource::Load(file);
  if (!source) return source.diagnostics();

  MeshMessages messages;
  PolygonSoup soup;
  if (const std::string extension = LowerExtension(file); extension == ".obj") {
    soup = ReadObjPolygons(*source, options.scale, messages);
  } else if (extension == ".ply") {
    soup = ReadPlyPolygons(*source, options.scale, messages);
  } else {
    return MakeError(PathText(file), "expected a mesh that ends in .obj or .ply, got " +
                                         (extension.empty() ? "no extension" : Quote(extension, 20)));
  }
  if (messages.full()) messages.Add(MakeNote(PathText(file), "reading stopped here; there may be more errors"));
  if (messages.failed()) return messages.Take();

  RestMesh mesh = Importer(*source, soup, options, messages).Make();
  mesh.name = PathText(file.stem());
  if (messages.failed()) return messages.Take();
  return {std::move(mesh), messages.Take()};
}

}  // namespace percale
