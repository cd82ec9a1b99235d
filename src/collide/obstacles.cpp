#include "collide/obstacles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collide/poses.h"
#include "mesh/topology.h"
#include "mesh/vertex_cache.h"

namespace percale {
namespace {

/// Edges of the polygon that stands for a rim.
constexpr int kRim = 48;

std::size_t Index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// What stands out of a solid: vertices, and edges between them.
struct Features {
  std::vector<Vec3> vertices;
  std::vector<Edge> edges;

  void AddRim(double radius, double y) {
    const auto first = static_cast<std::int32_t>(vertices.size());
    for (int k = 0; k < kRim; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRim;
      vertices.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
      edges.push_back({first + k, first + (k + 1) % kRim});
    }
  }
};

Features FeaturesOf(const ColliderSettings& collider) {
  Features f;
  switch (collider.shape) {
    case ColliderShape::Box: {
      const Vec3 half = collider.size * 0.5;
      for (int k = 0; k < 8; ++k)
        f.vertices.push_back({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
      for (std::int32_t k = 0; k < 8; ++k) {
        for (const std::int32_t axis : {1, 2, 4}) {
          if (!(k & axis)) f.edges.push_back({k, k | axis});
        }
      }
      break;
    }
    case ColliderShape::Cylinder:
      f.AddRim(collider.radius, -collider.length / 2);
      f.AddRim(collider.radius, collider.length / 2);
      break;
    case ColliderShape::Cone:
      f.AddRim(collider.radius, -collider.length / 2);
      f.vertices.push_back({0, collider.length / 2, 0});
      break;
    default:
      break;
  }
  return f;
}

}  // namespace

Obstacles::Obstacles(const Scene& scene) {
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    const ColliderSettings& collider = scene.colliders[c];
    shapes_.push_back(collider.shape);
    meshes_.push_back(collider.loaded);
    Obstacle obstacle{static_cast<int>(c), vertices_, {}};
    if (collider.shape == ColliderShape::Mesh) {
      if (!collider.loaded) continue;
      const RestMesh& mesh = collider.loaded->mesh;
      obstacle.local = mesh.positions;
      for (const Triangle& t : mesh.triangles)
        triangles_.push_back({t.a + vertices_, t.b + vertices_, t.c + vertices_});
    } else {
      Features features = FeaturesOf(collider);
      obstacle.local = std::move(features.vertices);
      for (const Edge& e : features.edges) edges_.push_back({e.a + vertices_, e.b + vertices_});
    }
    if (obstacle.local.empty()) continue;
    vertices_ += static_cast<int>(obstacle.local.size());
    all_.push_back(std::move(obstacle));
  }
}

void Obstacles::AddTo(ContactMesh& mesh) const {
  const std::int32_t first = mesh.vertices();
  std::int32_t body = mesh.clothBodies;
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
  if (scene.colliders.size() != shapes_.size()) return false;
  for (std::size_t c = 0; c < shapes_.size(); ++c) {
    if (scene.colliders[c].shape != shapes_[c] || scene.colliders[c].loaded != meshes_[c]) return false;
  }
  return true;
}

void Obstacles::Configure(const Scene& scene) {
  for (Obstacle& obstacle : all_) {
    const ColliderSettings& collider = scene.colliders[Index(obstacle.collider)];
    if (collider.shape != ColliderShape::Mesh) obstacle.local = FeaturesOf(collider).vertices;
  }
}

void Obstacles::PlaceAt(const Scene& scene, double time, std::span<Vec3> positions) const {
  for (const Obstacle& obstacle : all_) {
    const ColliderSettings& collider = scene.colliders[Index(obstacle.collider)];
    const Pose pose = PoseOf(scene, obstacle.collider, time);
    const std::span<Vec3> own = positions.subspan(Index(obstacle.first), obstacle.local.size());
    if (HasCache(collider))
      PlaceVertices(scene, collider, time, own);
    else
      std::copy(obstacle.local.begin(), obstacle.local.end(), own.begin());
    for (Vec3& x : own) x = ToWorld(pose, x);
  }
}

}  // namespace percale
