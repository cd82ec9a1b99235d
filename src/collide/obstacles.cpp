#include "collide/obstacles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collide/poses.h"
#include "core/index.h"
#include "mesh/topology.h"
#include "mesh/vertex_cache.h"

namespace percale {
namespace {

/// Edges of the polygon that stands for a rim.
constexpr int kRim = 48;

/// Some of what stands for a solid: vertices, and edges between them.
struct Features {
  std::vector<Vec3> vertices;
  std::vector<Edge> edges;
  double core = 0;  // solid all around them [m]

  void AddRim(double radius, double y) {
    const auto first = static_cast<std::int32_t>(vertices.size());
    for (int k = 0; k < kRim; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRim;
      vertices.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
      edges.push_back({first + k, first + (k + 1) % kRim});
    }
  }
};

Features MakeAxis(double halfLength, double core) {
  return {{{0, -halfLength, 0}, {0, halfLength, 0}}, {{0, 1}}, core};
}

Features MakeBox(const Vec3& half) {
  Features f;
  for (int k = 0; k < 8; ++k)
    f.vertices.push_back({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
  for (std::int32_t k = 0; k < 8; ++k) {
    for (const std::int32_t axis : {1, 2, 4}) {
      if (!(k & axis)) f.edges.push_back({k, k | axis});
    }
  }
  return f;
}

/// As many of each shape, whatever its sizes.
std::vector<Features> FeaturesOf(const ColliderSettings& collider) {
  const double radius = collider.radius, half = collider.length / 2;
  Features rims;
  switch (collider.shape) {
    case ColliderShape::Sphere:
      return {{{{}}, {}, radius}};
    case ColliderShape::Capsule:
      return {MakeAxis(half, radius)};
    case ColliderShape::Torus:
      rims.AddRim(radius, 0);
      // A polygon lies within its circle.
      rims.core = std::max(0.0, collider.tubeRadius - radius * (1 - std::cos(std::numbers::pi / kRim)));
      return {rims};
    case ColliderShape::Box:
      return {MakeBox(collider.size * 0.5)};
    case ColliderShape::Cylinder: {
      rims.AddRim(radius, -half);
      rims.AddRim(radius, half);
      const double core = std::min(radius, half);
      return {rims, MakeAxis(half - core, core)};
    }
    case ColliderShape::Cone:
      rims.AddRim(radius, -half);
      rims.vertices.push_back({0, half, 0});
      return {rims, MakeAxis(half, 0)};
    default:
      return {};
  }
}

}  // namespace

Obstacles::Obstacles(const Scene& scene) {
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    const ColliderSettings& collider = scene.colliders[c];
    shapes_.push_back(collider.shape);
    meshes_.push_back(collider.loaded);
    if (collider.shape == ColliderShape::Mesh) {
      if (!collider.loaded) continue;
      const RestMesh& mesh = collider.loaded->mesh;
      for (const Triangle& t : mesh.triangles)
        triangles_.push_back({t.a + vertices_, t.b + vertices_, t.c + vertices_});
      Add(static_cast<int>(c), mesh.positions, 0);
    }
    for (Features& features : FeaturesOf(collider)) {
      for (const Edge& e : features.edges) edges_.push_back({e.a + vertices_, e.b + vertices_});
      Add(static_cast<int>(c), std::move(features.vertices), features.core);
    }
  }
  for (std::size_t s = 0; s < scene.spheres.size(); ++s) {
    Add(-1, {scene.spheres[s].origin}, scene.spheres[s].radius);
    all_.back().sphere = static_cast<int>(s);
  }
}

double FrictionOf(const Scene& scene, const Obstacle& obstacle) {
  return obstacle.sphere >= 0 ? scene.spheres[Index(obstacle.sphere)].friction
                              : scene.colliders[Index(obstacle.collider)].friction;
}

void Obstacles::Add(int collider, std::vector<Vec3> local, double core) {
  const int first = vertices_;
  vertices_ += static_cast<int>(local.size());
  all_.push_back({collider, -1, first, std::move(local), core});
}

void Obstacles::AddTo(ContactMesh& mesh) const {
  const std::int32_t first = mesh.vertices();
  std::int32_t body = mesh.clothBodies;
  mesh.body.reserve(mesh.body.size() + Index(vertices_));
  mesh.place.reserve(mesh.place.size() + Index(vertices_));
  for (const Obstacle& obstacle : all_) {
    mesh.body.insert(mesh.body.end(), obstacle.local.size(), body++);
    mesh.place.insert(mesh.place.end(), obstacle.local.begin(), obstacle.local.end());
  }
  for (const Triangle& t : triangles_) mesh.triangles.push_back({t.a + first, t.b + first, t.c + first});
  for (const Edge& e : BuildTopology(Index(vertices_), triangles_).edges)
    mesh.edges.push_back({e.a + first, e.b + first});
  for (const Edge& e : edges_) mesh.edges.push_back({e.a + first, e.b + first});
}

bool Obstacles::Fit(const Scene& scene) const {
  const auto isSphere = [](const Obstacle& obstacle) { return obstacle.sphere >= 0; };
  const auto spheres = std::count_if(all_.begin(), all_.end(), isSphere);
  if (scene.colliders.size() != shapes_.size() || scene.spheres.size() != Index(spheres)) return false;
  for (std::size_t c = 0; c < shapes_.size(); ++c) {
    if (scene.colliders[c].shape != shapes_[c] || scene.colliders[c].loaded != meshes_[c]) return false;
  }
  return true;
}

void Obstacles::Configure(const Scene& scene) {
  auto obstacle = all_.begin();
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    if (scene.colliders[c].shape == ColliderShape::Mesh) {
      obstacle += scene.colliders[c].loaded ? 1 : 0;
      continue;
    }
    for (Features& features : FeaturesOf(scene.colliders[c])) {
      obstacle->local = std::move(features.vertices);
      (obstacle++)->core = features.core;
    }
  }
  for (const SphereSettings& sphere : scene.spheres) {
    obstacle->local = {sphere.origin};
    (obstacle++)->core = sphere.radius;
  }
}

void Obstacles::PlaceAt(const Scene& scene, double time, std::span<Vec3> positions) const {
  for (const Obstacle& obstacle : all_) {
    const std::span<Vec3> own = positions.subspan(Index(obstacle.first), obstacle.local.size());
    std::copy(obstacle.local.begin(), obstacle.local.end(), own.begin());
    if (obstacle.collider < 0) continue;
    const ColliderSettings& collider = scene.colliders[Index(obstacle.collider)];
    if (HasCache(collider)) PlaceVertices(scene, collider, time, own);
    const Pose pose = PoseOf(scene, obstacle.collider, time);
    for (Vec3& x : own) x = ToWorld(pose, x);
  }
}

}  // namespace percale
