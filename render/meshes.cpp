// Attributes of drawn meshes: normals, tangents, and the meshes of spheres and planes.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "render/scene_view.h"

namespace percale {
namespace {

struct Float3 {
  float x, y, z;
};

Float3 At(std::span<const float> positions, std::int32_t vertex) {
  const float* p = &positions[static_cast<std::size_t>(vertex) * 3];
  return {p[0], p[1], p[2]};
}
Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

// Four at once, so that one vector instruction adds them.
void AddTo(float* sum, const Float3& v) {
  const float four[4] = {v.x, v.y, v.z, 0};
  for (int k = 0; k < 4; ++k) sum[k] += four[k];
}

}  // namespace

void ComputeNormals(std::span<const float> positions, std::span<const Triangle> triangles, std::span<float> normals) {
  assert(normals.size() / 4 == positions.size() / 3);
  std::fill(normals.begin(), normals.end(), 0.0f);
  for (const Triangle& t : triangles) {
    const Float3 a = At(positions, t.a), u = At(positions, t.b) - a, v = At(positions, t.c) - a;
    // As long as twice the area: the weight.
    const Float3 n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    AddTo(&normals[static_cast<std::size_t>(t.a) * 4], n);
    AddTo(&normals[static_cast<std::size_t>(t.b) * 4], n);
    AddTo(&normals[static_cast<std::size_t>(t.c) * 4], n);
  }
  for (std::size_t i = 0; i < normals.size(); i += 4) {
    float* n = &normals[i];
    const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const bool hasDirection = square > 1e-30f;
    const float scale = hasDirection ? 1 / std::sqrt(square) : 0;
    for (int k = 0; k < 4; ++k) n[k] *= scale;
    n[2] = hasDirection ? n[2] : 1;
  }
}

void ComputeTangents(std::span<const float> positions, std::span<const Vec2> uv, std::span<const float> normals,
                     std::span<const Triangle> triangles, std::span<float> tangents) {
  assert(tangents.size() == normals.size());
  std::fill(tangents.begin(), tangents.end(), 0.0f);
  for (const Triangle& t : triangles) {
    const Float3 a = At(positions, t.a), p = At(positions, t.b) - a, q = At(positions, t.c) - a;
    const Vec2 ua = uv[static_cast<std::size_t>(t.a)], ub = uv[static_cast<std::size_t>(t.b)],
               uc = uv[static_cast<std::size_t>(t.c)];
    const auto u1 = static_cast<float>(ub.x - ua.x), v1 = static_cast<float>(ub.y - ua.y);
    const auto u2 = static_cast<float>(uc.x - ua.x), v2 = static_cast<float>(uc.y - ua.y);
    // p = u1 T + v1 B and q = u2 T + v2 B, solved for T; the sign of the determinant is the
    // triangle's turn in the texture, its size a weight that is dropped.
    const float turn = u1 * v2 - u2 * v1 < 0 ? -1.0f : 1.0f;
    const Float3 tangent = {turn * (p.x * v2 - q.x * v1), turn * (p.y * v2 - q.y * v1), turn * (p.z * v2 - q.z * v1)};
    AddTo(&tangents[static_cast<std::size_t>(t.a) * 4], tangent);
    AddTo(&tangents[static_cast<std::size_t>(t.b) * 4], tangent);
    AddTo(&tangents[static_cast<std::size_t>(t.c) * 4], tangent);
  }
  for (std::size_t i = 0; i < tangents.size(); i += 4) {
    float* t = &tangents[i];
    const float* n = &normals[i];
    const float along = n[0] * t[0] + n[1] * t[1] + n[2] * t[2];
    for (int k = 0; k < 3; ++k) t[k] -= along * n[k];
    const float square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    const bool hasDirection = square > 1e-30f;
    const float scale = hasDirection ? 1 / std::sqrt(square) : 0;
    for (int k = 0; k < 3; ++k) t[k] *= scale;
    t[0] = hasDirection ? t[0] : 1;
  }
}

DrawMesh MakeSphereMesh(int latitudes, int longitudes) {
  assert(latitudes >= 2 && longitudes >= 3);
  DrawMesh mesh;
  const auto add = [](std::vector<float>& to, std::initializer_list<double> values) {
    for (const double value : values) to.push_back(static_cast<float>(value));
  };
  for (int i = 0; i <= latitudes; ++i) {
    const double v = double(i) / latitudes;
    const double ring = std::sin(std::numbers::pi * v), y = std::cos(std::numbers::pi * v);
    for (int j = 0; j <= longitudes; ++j) {
      // u = 1/2 faces +z, where the course's camera stands; the seam is behind.
      const double u = double(j) / longitudes, angle = 2 * std::numbers::pi * u;
      const double x = -ring * std::sin(angle), z = -ring * std::cos(angle);
      add(mesh.positions, {x, y, z});
      add(mesh.normals, {x, y, z, 0});
      add(mesh.tangents, {-std::cos(angle), 0, std::sin(angle), 0});
      add(mesh.uv, {u, v});
    }
  }
  for (int i = 0; i < latitudes; ++i) {
    for (int j = 0; j < longitudes; ++j) {
      const auto a = static_cast<std::uint32_t>(i * (longitudes + 1) + j), b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(longitudes + 1), d = c + 1;
      // At the poles one of the two triangles of a quad has no area.
      if (i > 0) mesh.triangles.insert(mesh.triangles.end(), {a, c, b});
      if (i < latitudes - 1) mesh.triangles.insert(mesh.triangles.end(), {b, c, d});
    }
  }
  return mesh;
}

DrawMesh MakePlaneMesh(const Vec3& point, const Vec3& normal) {
  constexpr double kHalf = 2;  // [m]
  const Vec3 n = UnitOr(normal, {0, 1, 0});
  // The edges of a level plane run along x and z; of a plane that faces sideways, along y.
  const Vec3 hint = std::abs(n.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 0, -1};
  const Vec3 right = UnitOr(hint - Dot(hint, n) * n, {1, 0, 0});
  const Vec3 up = Cross(n, right);
  DrawMesh mesh;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const Vec3 x = point + kHalf * ((2 * i - 1) * right + (1 - 2 * j) * up);
      for (const double value : {x.x, x.y, x.z}) mesh.positions.push_back(static_cast<float>(value));
      for (const double value : {n.x, n.y, n.z, 0.0}) mesh.normals.push_back(static_cast<float>(value));
      for (const double value : {right.x, right.y, right.z, 0.0}) mesh.tangents.push_back(static_cast<float>(value));
      mesh.uv.insert(mesh.uv.end(), {float(i), float(j)});
    }
  }
  mesh.triangles = {0, 2, 1, 1, 2, 3};
  return mesh;
}

}  // namespace percale
