#pragma once
/// \file
/// What of a scene's colliders and spheres cloth meets as vertices, edges and triangles: meshes whole, and of solids
/// their corners and rims, and the middle of what is round, a point or a line with all around it that is solid: the
/// distance of a solid from the vertices of cloth alone would let these through between them.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "collide/contact_mesh.h"
#include "percale/scene.h"

namespace percale {

struct Obstacle {
  int collider = 0;         ///< Index among Scene::colliders; -1: it is a sphere.
  int sphere = -1;          ///< Index among Scene::spheres; -1: it is a collider.
  std::int32_t first = 0;   ///< Its first vertex among those of all obstacles.
  std::vector<Vec3> local;  ///< Its vertices, in the collider's frame, or the world's, without its cache [m].
  double core = 0;          ///< So far all is solid around these and the edges between them [m].
};

/// Coulomb's coefficient.
double FrictionOf(const Scene& scene, const Obstacle& obstacle);

class Obstacles {
 public:
  /// Those of the scene, as at its start; where they are is for PlaceAt to say.
  explicit Obstacles(const Scene& scene);

  /// Adds them to a mesh that holds the cloths. A body each; a collider may be several.
  void AddTo(ContactMesh& mesh) const;
  /// Whether those of this scene are the same but for where they are, and how large.
  bool Fit(const Scene& scene) const;
  /// Takes their sizes; they must fit.
  void Configure(const Scene& scene);

  int vertices() const { return vertices_; }
  std::span<const Obstacle> all() const { return all_; }
  /// Those of no triangle, of vertices of all obstacles: edges and rims of solids.
  std::span<const Edge> loneEdges() const { return edges_; }
  /// Where their vertices are at `time` [s]. `positions`: vertices() of them [m].
  void PlaceAt(const Scene& scene, double time, std::span<Vec3> positions) const;

 private:
  void Add(int collider, std::vector<Vec3> local, double core);

  std::vector<Obstacle> all_;                              // by collider, then the spheres
  std::vector<ColliderShape> shapes_;                      // per collider of the scene
  std::vector<std::shared_ptr<const LoadedMesh>> meshes_;  // per collider
  std::vector<Edge> edges_;                                // without triangles; of vertices of all obstacles
  std::vector<Triangle> triangles_;
  int vertices_ = 0;
};

}  // namespace percale
