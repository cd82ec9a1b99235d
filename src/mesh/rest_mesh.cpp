#include "mesh/rest_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "math/splitmix64.h"
#include "mesh/cloth_model.h"

namespace percale {
namespace {

/// Below this share of what it could be, a direction or an area counts as none.
constexpr double kNone = 1e-9;

double Cross2(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}
Vec2 Minus(const Vec2& a, const Vec2& b) {
  return {a.x - b.x, a.y - b.y};
}

/// The direction of the warp in a triangle with edges e1 and e2 from its first corner and unit normal n; not of
/// length 1.
Vec3 WarpDirection(const Vec3& e1, const Vec3& e2, const Vec3& n, std::span<const Vec2> uv,
                   const std::optional<Vec3>& warp) {
  if (!uv.empty()) {
    const Vec2 d1 = Minus(uv[1], uv[0]), d2 = Minus(uv[2], uv[0]);
    const double area = Cross2(d1, d2);
    const double most = std::max(d1.x * d1.x + d1.y * d1.y, d2.x * d2.x + d2.y * d2.y);
    // Where texture (u, v) has position p: e = p_u du + p_v dv along both edges, solved for p_u.
    if (std::abs(area) > kNone * most) return (d2.y / area) * e1 - (d1.y / area) * e2;  // false for NaN
  }
  if (warp) {
    const Vec3 within = *warp - Dot(*warp, n) * n;
    if (Length(within) > kNone * Length(*warp)) return within;
  }
  return e1;
}

/// Turns points around the middle of their box: about x, then y, then z [degree].
void Rotate(const Vec3& degrees, std::vector<Vec3>& points) {
  if (degrees == Vec3{} || points.empty()) return;
  Vec3 low = points[0], high = low;
  for (const Vec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 middle = 0.5 * (low + high), angle = degrees * (std::numbers::pi / 180);
  const auto turn = [](double& a, double& b, double by) {
    const double c = std::cos(by), s = std::sin(by), turned = c * a - s * b;
    b = s * a + c * b;
    a = turned;
  };
  for (Vec3& p : points) {
    p -= middle;
    turn(p.y, p.z, angle.x);
    turn(p.z, p.x, angle.y);
    turn(p.x, p.y, angle.z);
    p += middle;
  }
}

/// A disc as the settings place it: around (0, 1, 0), lying, or standing with a slight random z.
RestMesh MakePlacedDisc(const ClothSettings& settings) {
  RestMesh mesh = MakeDisc(settings.radius, settings.rings);
  SplitMix64 random(static_cast<std::uint64_t>(settings.seed));
  for (Vec3& p : mesh.positions) {
    p = settings.orientation == Orientation::Horizontal ? Vec3{p.x, 1, p.z}
                                                        : Vec3{p.x, 1 - p.z, (2 * random.NextUnit() - 1) / 1000};
    p += settings.origin;
  }
  return mesh;
}

}  // namespace

RestMesh MakeClothMesh(const ClothSettings& settings) {
  RestMesh mesh;
  switch (settings.shape) {
    case Shape::Grid:
      mesh = MakeGridMesh(settings);
      break;
    case Shape::Disc:
      mesh = MakePlacedDisc(settings);
      break;
    case Shape::Mesh:
      assert(settings.loaded);
      mesh = settings.loaded->mesh;
      for (Vec3& p : mesh.positions) p += settings.origin;
      break;
  }
  Rotate(settings.rotation, mesh.positions);
  return mesh;
}

RestMesh MakeGridMesh(const ClothSettings& settings) {
  ClothModel grid = MakeGrid(settings);
  RestMesh mesh;
  mesh.name = "grid";
  mesh.positions = std::move(grid.start);
  mesh.triangles = std::move(grid.triangles);
  mesh.uv = std::move(grid.uv);
  mesh.material.reserve(3 * mesh.triangles.size());
  const double spacingX = settings.width / (grid.numWidth - 1), spacingY = settings.height / (grid.numHeight - 1);
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : {t.a, t.b, t.c}) {
      const int i = v % grid.numWidth, j = v / grid.numWidth;
      mesh.material.push_back({i * spacingX, (grid.numHeight - 1 - j) * spacingY});
    }
  }
  return mesh;
}

RestMesh MakeDisc(double radius, int rings) {
  assert(radius > 0 && rings >= 1);
  RestMesh mesh;
  mesh.name = "disc";
  const auto count = static_cast<std::size_t>(rings);
  std::vector<Vec2> plane{{0, 0}};
  plane.reserve(1 + 3 * count * (count + 1));
  for (int k = 1; k <= rings; ++k) {
    const double r = radius * k / rings;
    for (int j = 0; j < 6 * k; ++j) {
      const double angle = 2 * std::numbers::pi * j / (6 * k);
      plane.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
  }
  // Ring k - 1 and ring k, sector by sector: k edges outside face k - 1 inside.
  mesh.triangles.reserve(6 * count * count);
  for (int k = 1; k <= rings; ++k) {
    const auto outer = [&](int j) { return 1 + 3 * k * (k - 1) + j % (6 * k); };
    const auto inner = [&](int j) { return k == 1 ? 0 : 1 + 3 * (k - 1) * (k - 2) + j % (6 * (k - 1)); };
    for (int sector = 0; sector < 6; ++sector) {
      for (int j = 0; j < k; ++j) {
        const int o = sector * k + j, i = sector * (k - 1) + j;
        mesh.triangles.push_back({inner(i), outer(o), outer(o + 1)});
        if (j + 1 < k) mesh.triangles.push_back({inner(i), outer(o + 1), inner(i + 1)});
      }
    }
  }
  for (const Vec2& p : plane) {
    mesh.positions.push_back({p.x, 0, -p.y});
    mesh.uv.push_back({0.5 + p.x / (2 * radius), 0.5 + p.y / (2 * radius)});
  }
  mesh.material.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : {t.a, t.b, t.c}) mesh.material.push_back(plane[static_cast<std::size_t>(v)]);
  }
  return mesh;
}

std::vector<Vec2> MaterialFromShape(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                    std::span<const Vec2> cornerUv, const std::optional<Vec3>& warp) {
  assert(cornerUv.empty() || cornerUv.size() == 3 * triangles.size());
  std::vector<Vec2> material(3 * triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const Vec3& a = positions[static_cast<std::size_t>(t.a)];
    const Vec3 e1 = positions[static_cast<std::size_t>(t.b)] - a, e2 = positions[static_cast<std::size_t>(t.c)] - a;
    const Vec3 normal = UnitOr(Cross(e1, e2), {0, 0, 0});
    if (normal == Vec3{0, 0, 0}) continue;
    const std::span<const Vec2> uv = cornerUv.empty() ? cornerUv : cornerUv.subspan(3 * i, 3);
    const Vec3 x = UnitOr(WarpDirection(e1, e2, normal, uv, warp), {1, 0, 0}), y = Cross(normal, x);
    material[3 * i + 1] = {Dot(e1, x), Dot(e1, y)};
    material[3 * i + 2] = {Dot(e2, x), Dot(e2, y)};
  }
  return material;
}

std::vector<Vec2> MaterialFromUv(std::span<const Vec2> cornerUv, double metresPerUv) {
  assert(cornerUv.size() % 3 == 0 && metresPerUv > 0);
  std::vector<Vec2> material(cornerUv.begin(), cornerUv.end());
  for (Vec2& p : material) p = {metresPerUv * p.x, metresPerUv * p.y};
  for (std::size_t t = 0; 3 * t < material.size(); ++t) {
    if (!(MaterialArea(material, t) < 0)) continue;
    for (std::size_t k = 0; k < 3; ++k) material[3 * t + k].y = -material[3 * t + k].y;
  }
  return material;
}

double MaterialArea(std::span<const Vec2> material, std::size_t triangle) {
  const Vec2* p = &material[3 * triangle];
  return Cross2(Minus(p[1], p[0]), Minus(p[2], p[0])) / 2;
}

std::vector<Vec2> ProjectedUv(std::span<const Vec3> positions) {
  std::vector<Vec2> uv(positions.size());
  if (positions.empty()) return uv;
  const auto coordinates = [](const Vec3& p) { return std::array<double, 3>{p.x, p.y, p.z}; };
  std::array<double, 3> low = coordinates(positions[0]), side{};
  std::array<double, 3> high = low;
  for (const Vec3& p : positions) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], coordinates(p)[k]);
      high[k] = std::max(high[k], coordinates(p)[k]);
    }
  }
  std::size_t shortest = 2, first = 0;
  for (std::size_t k = 0; k < 3; ++k) side[k] = high[k] - low[k];
  for (std::size_t k = 0; k < 2; ++k) {
    if (side[k] < side[shortest]) shortest = k;
  }
  if (shortest == 0) first = 1;
  const std::size_t second = 3 - first - shortest;
  const double longest = std::max(side[first], side[second]);
  if (!(longest > 0)) return uv;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const auto p = coordinates(positions[v]);
    uv[v] = {(p[first] - low[first]) / longest, (p[second] - low[second]) / longest};
  }
  return uv;
}

}  // namespace percale
