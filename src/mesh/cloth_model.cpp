#include "mesh/cloth_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "math/splitmix64.h"
#include "mesh/rest_mesh.h"

namespace percale {

ClothModel MakeGrid(const ClothSettings& settings) {
  ClothModel model;
  const int nw = model.numWidth = settings.numWidthPoints;
  const int nh = model.numHeight = settings.numHeightPoints;
  const std::size_t count = static_cast<std::size_t>(nw) * static_cast<std::size_t>(nh);
  model.start.reserve(count);
  model.uv.reserve(count);

  const double spacingX = settings.width / (nw - 1);
  const double spacingY = settings.height / (nh - 1);
  SplitMix64 random(static_cast<std::uint64_t>(settings.seed));
  for (int j = 0; j < nh; ++j) {
    for (int i = 0; i < nw; ++i) {
      const Vec3 p = settings.orientation == Orientation::Horizontal
                         ? Vec3{i * spacingX, 1, j * spacingY}
                         : Vec3{i * spacingX, j * spacingY, (2 * random.NextUnit() - 1) / 1000};
      model.start.push_back(p + settings.origin);
      model.uv.push_back({static_cast<double>(i) / (nw - 1), static_cast<double>(j) / (nh - 1)});
    }
  }

  model.triangles.reserve(2 * static_cast<std::size_t>(nw - 1) * static_cast<std::size_t>(nh - 1));
  for (int j = 0; j + 1 < nh; ++j) {
    for (int i = 0; i + 1 < nw; ++i) {
      const std::int32_t a = j * nw + i, b = a + 1, c = a + nw, d = c + 1;
      model.triangles.push_back({a, c, b});
      model.triangles.push_back({b, c, d});
    }
  }
  return model;
}

std::int64_t VertexCount(const ClothSettings& settings) {
  switch (settings.shape) {
    case Shape::Grid:
      return std::int64_t{settings.numWidthPoints} * settings.numHeightPoints;
    case Shape::Disc:
      return 1 + 3 * std::int64_t{settings.rings} * (settings.rings + 1);
    case Shape::Mesh:
      break;
  }
  return settings.loaded ? static_cast<std::int64_t>(settings.loaded->mesh.positions.size()) : 0;
}

std::optional<std::int32_t> VertexOf(const ClothSettings& settings, const GridPoint& point) {
  const auto [i, j] = point;
  if (settings.shape == Shape::Grid) {
    if (i < 0 || j < 0 || i >= settings.numWidthPoints || j >= settings.numHeightPoints) return std::nullopt;
    return j * settings.numWidthPoints + i;
  }
  if (i < 0 || j != 0) return std::nullopt;
  if (settings.shape == Shape::Mesh && settings.loaded && !settings.loaded->mesh.source.empty()) {
    const std::vector<std::int32_t>& source = settings.loaded->mesh.source;
    const auto found = std::lower_bound(source.begin(), source.end(), i);
    if (found == source.end() || *found != i) return std::nullopt;
    return static_cast<std::int32_t>(found - source.begin());
  }
  return i < VertexCount(settings) ? std::optional(i) : std::nullopt;
}

GridPoint PointOf(const ClothSettings& settings, std::int32_t vertex) {
  if (settings.shape == Shape::Grid) return {vertex % settings.numWidthPoints, vertex / settings.numWidthPoints};
  if (settings.shape == Shape::Mesh && settings.loaded && !settings.loaded->mesh.source.empty())
    return {settings.loaded->mesh.source[static_cast<std::size_t>(vertex)], 0};
  return {vertex, 0};
}

MeshOptions MeshOptionsOf(const ClothSettings& settings) {
  return {.scale = settings.meshScale,
          .rest = settings.restShape,
          .metresPerUv = settings.metresPerUv,
          .weld = settings.weld,
          .weldDistance = settings.weldDistance};
}

const VertexGroup* FindVertexGroup(const ClothSettings& settings, std::string_view name) {
  if (settings.shape != Shape::Mesh || !settings.loaded || name.empty()) return nullptr;
  for (const VertexGroup& group : settings.loaded->mesh.groups) {
    if (group.name == name) return &group;
  }
  return nullptr;
}

ClothSize SizeOf(const ClothSettings& settings) {
  switch (settings.shape) {
    case Shape::Grid:
      return {
          std::max(settings.width, settings.height), settings.width * settings.height,
          std::max(settings.width / (settings.numWidthPoints - 1), settings.height / (settings.numHeightPoints - 1))};
    case Shape::Disc:
      return {2 * settings.radius, std::numbers::pi * settings.radius * settings.radius,
              settings.radius / settings.rings};
    case Shape::Mesh:
      break;
  }
  assert(settings.loaded);
  const RestMesh& mesh = settings.loaded->mesh;
  ClothSize size;
  Vec3 low = mesh.positions[0], high = low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  size.extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) size.area += MaterialArea(mesh.material, t);
  // A right triangle of a grid has half the square of its spacing.
  size.spacing = std::sqrt(2 * size.area / static_cast<double>(mesh.triangles.size()));
  return size;
}

std::vector<std::int32_t> PinnedVertices(const ClothSettings& settings) {
  std::vector<std::int32_t> vertices;
  for (const GridPoint& pin : settings.pinned) {
    if (const auto vertex = VertexOf(settings, pin)) vertices.push_back(*vertex);
  }
  if (const VertexGroup* const group = FindVertexGroup(settings, settings.pinnedGroup))
    vertices.insert(vertices.end(), group->vertices.begin(), group->vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

double PointMass(const ClothSettings& cloth) {
  const double points = static_cast<double>(cloth.numWidthPoints) * static_cast<double>(cloth.numHeightPoints);
  return cloth.width * cloth.height * cloth.density / points;
}

bool Enabled(const ClothSettings& cloth, SpringKind kind) {
  switch (kind) {
    case SpringKind::Left:
    case SpringKind::Up:
      return cloth.enableStructural;
    case SpringKind::UpperLeft:
    case SpringKind::UpperRight:
      return cloth.enableShearing;
    case SpringKind::TwoLeft:
    case SpringKind::TwoUp:
      break;
  }
  return cloth.enableBending;
}

std::vector<Edge> EnabledSprings(const ClothModel& model, const ClothSettings& settings) {
  std::vector<Edge> springs;
  for (int j = 0; j < model.numHeight; ++j) {
    for (int i = 0; i < model.numWidth; ++i) {
      for (int kind = 0; kind < kSpringKinds; ++kind) {
        const auto [di, dj] = kSpringSteps[kind];
        if (!Enabled(settings, static_cast<SpringKind>(kind))) continue;
        if (i + di < 0 || i + di >= model.numWidth || j + dj < 0) continue;
        const std::int32_t p = j * model.numWidth + i;
        springs.push_back({p, p + dj * model.numWidth + di});
      }
    }
  }
  return springs;
}

std::vector<double> LengthsOf(std::span<const Edge> springs, std::span<const Vec3> rest) {
  std::vector<double> lengths;
  lengths.reserve(springs.size());
  for (const Edge& s : springs)
    lengths.push_back(Length(rest[static_cast<std::size_t>(s.a)] - rest[static_cast<std::size_t>(s.b)]));
  return lengths;
}

}  // namespace percale
