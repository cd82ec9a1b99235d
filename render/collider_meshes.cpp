// The meshes of drawn colliders, each in the collider's own frame.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>
#include <vector>

#include "core/index.h"
#include "mesh/topology.h"
#include "render/scene_view.h"

namespace percale {
namespace {

constexpr double kPi = std::numbers::pi;
/// Faces of a mesh that meet at more than this are drawn with an edge between them.
constexpr double kCosSharp = 0.7660444431189780;  // 40 degrees
/// Quads along an edge of a drawn box.
constexpr int kBoxQuads = 8;

void Add(std::vector<float>& to, std::initializer_list<double> values) {
  for (const double value : values) to.push_back(static_cast<float>(value));
}

std::uint32_t AddVertex(DrawMesh& mesh, const Vec3& position, const Vec3& normal, const Vec3& tangent, const Vec2& uv) {
  const auto index = static_cast<std::uint32_t>(mesh.VertexCount());
  Add(mesh.positions, {position.x, position.y, position.z});
  Add(mesh.normals, {normal.x, normal.y, normal.z, 0});
  Add(mesh.tangents, {tangent.x, tangent.y, tangent.z, 0});
  Add(mesh.uv, {uv.x, uv.y});
  return index;
}

/// A point of a profile: distance from the axis, height, and the normal in that plane.
struct ProfilePoint {
  double w, y, normalW, normalY;
};
using Profile = std::vector<ProfilePoint>;

/// Turns a profile around the y axis, as MakeSphereMesh does its half circle: seen from above clockwise from behind.
/// Two points at one place begin a new face with an edge of its own. `v` grows with the profile's length.
void AddLathe(const Profile& profile, int longitudes, DrawMesh& mesh) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < profile.size(); ++i)
    along.push_back(along.back() + std::hypot(profile[i].w - profile[i - 1].w, profile[i].y - profile[i - 1].y));
  const auto begin = static_cast<std::uint32_t>(mesh.VertexCount());
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ProfilePoint& p = profile[i];
    for (int j = 0; j <= longitudes; ++j) {
      const double u = double(j) / longitudes, angle = 2 * kPi * u;
      const Vec3 out{-std::sin(angle), 0, -std::cos(angle)};
      AddVertex(mesh, out * p.w + Vec3{0, p.y, 0}, out * p.normalW + Vec3{0, p.normalY, 0},
                {-std::cos(angle), 0, std::sin(angle)}, {u, along[i] / along.back()});
    }
  }
  const auto row = static_cast<std::uint32_t>(longitudes + 1);
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
    if (along[i] == along[i + 1]) continue;  // an edge
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t a = begin + i * row + j, b = a + 1, c = a + row, d = c + 1;
      // On the axis one of the two triangles of a quad has no area.
      if (profile[i].w > 0) mesh.triangles.insert(mesh.triangles.end(), {a, c, b});
      if (profile[i + 1].w > 0) mesh.triangles.insert(mesh.triangles.end(), {b, c, d});
    }
  }
}

/// A straight part of a profile with one normal, in pieces about as long as `piece` [m], at most `most`.
void AddStraight(const ProfilePoint& from, double w, double y, double piece, int most, Profile& profile) {
  const double length = std::hypot(w - from.w, y - from.y);
  const int count = static_cast<int>(std::clamp(std::round(length / piece), 1.0, double(most)));
  for (int k = 0; k <= count; ++k) {
    const double t = double(k) / count;
    profile.push_back({from.w + t * (w - from.w), from.y + t * (y - from.y), from.normalW, from.normalY});
  }
}

/// Part of a circle around (w, y) from one angle to another, measured from the axis upwards over the outside.
void AddArc(double w, double y, double radius, double from, double to, int count, Profile& profile) {
  for (int k = 0; k <= count; ++k) {
    const double angle = from + (to - from) * k / count;
    // Exactly on the axis at the poles.
    const double sin = angle == 0 || angle == kPi ? 0 : std::sin(angle);
    profile.push_back({w + radius * sin, y + radius * std::cos(angle), sin, std::cos(angle)});
  }
}

DrawMesh MakeBoxMesh(const Vec3& size) {
  DrawMesh mesh;
  const Vec3 half = size * 0.5;
  const auto scaled = [&](const Vec3& v) { return Vec3{v.x * half.x, v.y * half.y, v.z * half.z}; };
  // Normal and direction of growing u; v grows along their product, negative: down, where the sides stand.
  constexpr Vec3 kFaces[6][2] = {{{1, 0, 0}, {0, 0, -1}}, {{-1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {1, 0, 0}},
                                 {{0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 0}},  {{0, 0, -1}, {-1, 0, 0}}};
  for (const auto& [normal, right] : kFaces) {
    const Vec3 down = Cross(right, normal);
    const auto begin = static_cast<std::uint32_t>(mesh.VertexCount());
    for (int i = 0; i <= kBoxQuads; ++i) {
      for (int j = 0; j <= kBoxQuads; ++j) {
        const double u = double(j) / kBoxQuads, v = double(i) / kBoxQuads;
        AddVertex(mesh, scaled(normal + right * (2 * u - 1) + down * (2 * v - 1)), normal, right, {u, v});
      }
    }
    constexpr std::uint32_t kRow = kBoxQuads + 1;
    for (std::uint32_t i = 0; i < kBoxQuads; ++i) {
      for (std::uint32_t j = 0; j < kBoxQuads; ++j) {
        const std::uint32_t a = begin + i * kRow + j, b = a + 1, c = a + kRow, d = c + 1;
        mesh.triangles.insert(mesh.triangles.end(), {a, c, b, b, c, d});
      }
    }
  }
  return mesh;
}

/// Smooth where its faces meet at an obtuse angle, with edges elsewhere: every triangle has corners of its own.
DrawMesh MakeFacetedMesh(const RestMesh& rest, std::span<const Vec3> x) {
  const Topology topology = BuildTopology(x.size(), rest.triangles);
  std::vector<Vec3> faces;  // as long as twice the area: the weight
  for (const Triangle& t : rest.triangles) {
    const Vec3& a = x[Index(t.a)];
    faces.push_back(Cross(x[Index(t.b)] - a, x[Index(t.c)] - a));
  }
  DrawMesh mesh;
  std::vector<Vec2> uv;
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < rest.triangles.size(); ++t) {
    const Vec3 own = UnitOr(faces[t], {0, 1, 0});
    for (const std::int32_t v : {rest.triangles[t].a, rest.triangles[t].b, rest.triangles[t].c}) {
      Vec3 sum;
      for (std::int32_t c = topology.cornerBegin[Index(v)]; c < topology.cornerBegin[Index(v) + 1]; ++c) {
        const Vec3& other = faces[Index(topology.corners[Index(c)] / 3)];
        if (Dot(own, other) >= kCosSharp * Length(other)) sum += other;
      }
      uv.push_back(rest.uv[Index(v)]);
      mesh.triangles.push_back(AddVertex(mesh, x[Index(v)], UnitOr(sum, own), {}, uv.back()));
    }
    const auto first = static_cast<std::int32_t>(3 * t);
    triangles.push_back({first, first + 1, first + 2});
  }
  ComputeTangents(mesh.positions, uv, mesh.normals, triangles, mesh.tangents);
  return mesh;
}

}  // namespace

DrawMesh MakeColliderMesh(const ColliderSettings& collider, int latitudes, int longitudes,
                          std::span<const Vec3> vertices) {
  assert(latitudes >= 2 && longitudes >= 3);
  const double r = collider.radius, h = collider.length / 2;
  const double piece = 2 * kPi * r / longitudes;  // quads about square
  const int half = (latitudes + 1) / 2;
  Profile profile;
  switch (collider.shape) {
    case ColliderShape::Sphere:
      AddArc(0, 0, r, 0, kPi, latitudes, profile);
      break;
    case ColliderShape::Plane:
      return MakePlaneMesh({}, {0, 1, 0});
    case ColliderShape::Box:
      return MakeBoxMesh(collider.size);
    case ColliderShape::Capsule:
      AddArc(0, h, r, 0, kPi / 2, half, profile);
      AddStraight({r, h, 1, 0}, r, -h, piece, latitudes, profile);
      AddArc(0, -h, r, kPi / 2, kPi, half, profile);
      break;
    case ColliderShape::Cylinder:
      AddStraight({0, h, 0, 1}, r, h, piece, half, profile);
      AddStraight({r, h, 1, 0}, r, -h, piece, latitudes, profile);
      AddStraight({r, -h, 0, -1}, 0, -h, piece, half, profile);
      break;
    case ColliderShape::Cone: {
      const double slant = std::hypot(r, 2 * h);
      AddStraight({0, h, 2 * h / slant, r / slant}, r, -h, piece, latitudes, profile);
      AddStraight({r, -h, 0, -1}, 0, -h, piece, half, profile);
      break;
    }
    case ColliderShape::Torus:
      AddArc(r, 0, collider.tubeRadius, 0, 2 * kPi, latitudes, profile);
      break;
    case ColliderShape::Mesh:
      if (!collider.loaded) return {};
      return MakeFacetedMesh(collider.loaded->mesh, vertices.empty() ? collider.loaded->mesh.positions : vertices);
  }
  DrawMesh mesh;
  AddLathe(profile, longitudes, mesh);
  return mesh;
}

}  // namespace percale
