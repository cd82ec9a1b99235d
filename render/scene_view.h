#pragma once
/// \file
/// What is drawn of a World: the choices of a view, and the draw list made from both.

#include <array>
#include <filesystem>
#include <memory>
#include <span>

#include "percale/scene.h"
#include "percale/world.h"
#include "render/camera.h"
#include "render/draw_list.h"
#include "render/heat_scale.h"
#include "render/overlays.h"

namespace percale {

/// Of the radius of a ball, or of a sphere with Engine::Springs, what is drawn. Only points of cloth are kept out: at
/// its full radius the flat triangles between them would dip into it.
inline constexpr double kDrawnSphereRadius = 0.92;

/// How to look at a scene.
struct View {
  LookSettings look;  ///< Shader, colour, scales, tangents.
  OrbitCamera camera;
  int sphereLatitudes = 40;                       ///< >= 2: rings of a drawn sphere, the course's -a.
  int sphereLongitudes = 40;                      ///< >= 3: segments of a ring, the course's -o.
  bool wireframe = false;                         ///< Draw the springs over the surface as well.
  bool cloths = true;                             ///< Draw the cloths.
  bool colliders = true;                          ///< Draw the spheres, planes, other colliders and balls.
  int shadowMapSize = 1024;                       ///< [pixel]; 0: no shadows. Used by shaders that draw shadows.
  HeatMapSettings heatMap;                        ///< Colours the cloths by a quantity, in place of the shader.
  Overlays overlays;                              ///< What else is drawn over them.
  UniformValues uniforms;                         ///< Parameters of shaders that differ from their defaults.
  std::array<std::filesystem::path, 4> textures;  ///< PNG files for u_texture_1..4; empty: the project's own.

  /// Whether forces of contact are to be drawn, which are to be read then.
  bool ShowsForces() const { return cloths && (overlays.contacts || overlays.cones); }
  /// The view that a scene starts with: its look and its camera.
  static View ForScene(const Scene& scene);
};

/// One cloth as it is to be drawn: the spans of a ClothView, or copies of them.
struct ClothShape {
  std::span<const Vec3> positions;
  std::span<const Vec2> uv;
  std::span<const Triangle> triangles;
  std::span<const Edge> springs;
  // What heat maps and overlays need besides.
  std::span<const Vec3> rest = {};
  std::span<const Vec3> velocities = {};
  std::span<const std::int32_t> pinned = {};
  std::span<const double> restLengths = {};
};

/// Turns a World into a draw list, and keeps what stays the same from one picture to the next.
class SceneView {
 public:
  SceneView();
  ~SceneView();
  SceneView(SceneView&&) noexcept;
  SceneView& operator=(SceneView&&) noexcept;

  /// The draw list of a picture of that size [pixel, >= 1]. Valid until the next call.
  const DrawList& Update(const World& world, const View& view, int width, int height);
  /// The same from copies, for a World that runs on another thread: `cloths` in the scene's order, the colliders where
  /// they are at `time` [s], the contacts where the view asks for their forces.
  const DrawList& Update(const Scene& scene, std::span<const ClothShape> cloths, const View& view, int width,
                         int height, std::span<const Ball> balls = {}, double time = 0,
                         std::span<const ContactForce> contacts = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Vertex normals, each the sum of its triangles' normals weighted by their areas, made unit;
/// (0, 0, 1) where there is none. `positions` holds x y z per vertex, `normals` x y z 0.
void ComputeNormals(std::span<const float> positions, std::span<const Triangle> triangles, std::span<float> normals);

/// Vertex tangents along growing u, at right angles to the normals; (1, 0, 0) where there is none.
/// `tangents` holds x y z 0 per vertex.
void ComputeTangents(std::span<const float> positions, std::span<const Vec2> uv, std::span<const float> normals,
                     std::span<const Triangle> triangles, std::span<float> tangents);

/// The unit sphere as a grid of `latitudes` x `longitudes` quads, with uv = (longitude, latitude) in
/// 0..1 from the north pole down, its seam at -z (away from the course's camera), tangents along
/// growing longitude.
DrawMesh MakeSphereMesh(int latitudes, int longitudes);

/// A collider in its own frame, its curved surfaces as fine as a sphere of `latitudes` and `longitudes`. A mesh has its
/// own triangles, with edges where they meet sharply; none while its file is not read. `vertices`: where those of a
/// mesh are [m]; none: as in its file.
DrawMesh MakeColliderMesh(const ColliderSettings& collider, int latitudes, int longitudes,
                          std::span<const Vec3> vertices = {});

/// The square that stands for a plane: 4 m x 4 m around `point`, with uv 0..1.
DrawMesh MakePlaneMesh(const Vec3& point, const Vec3& normal);

}  // namespace percale
