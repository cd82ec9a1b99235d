#pragma once
/// \file
/// One picture as plain data: what to draw, with which shader, seen from where. Made by SceneView
/// without graphics, drawn by GlDevice.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/heat_scale.h"
#include "render/mat4.h"
#include "render/shader_library.h"

namespace percale {

using Color = std::array<float, 4>;

/// A surface, one array per attribute, in single precision as the card wants it.
struct DrawMesh {
  std::vector<float> positions;          ///< x y z per vertex [m].
  std::vector<float> normals;            ///< x y z 0 per vertex, unit.
  std::vector<float> tangents;           ///< x y z 0 per vertex, unit.
  std::vector<float> uv;                 ///< u v per vertex.
  std::vector<float> values;             ///< One per vertex, for a heat map; or none.
  std::vector<std::uint32_t> triangles;  ///< Three vertices each.
  std::vector<std::uint32_t> lines;      ///< Two vertices each: the springs.
  std::uint64_t shapeVersion = 0;        ///< Another number: positions, normals or values have changed.
  std::uint64_t meshVersion = 0;         ///< Another number: anything else has changed, or the sizes.

  std::size_t VertexCount() const { return positions.size() / 3; }
};

struct DrawItem {
  enum class Primitive { Triangles, Lines };
  std::shared_ptr<const DrawMesh> mesh;
  Primitive primitive = Primitive::Triangles;
  std::string shader;                ///< Name in the ShaderLibrary.
  Color color{1, 1, 1, 1};           ///< u_color.
  Mat4 model;                        ///< u_model: world space from the mesh's.
  bool pushBack = false;             ///< Lines of the same surface follow: leave them in front.
  Surface surface = Surface::Cloth;  ///< Chooses the part of the shader.
  bool castsShadow = false;          ///< Stands in the shadow map of shaders that want one.
  Color backColor{1, 1, 1, 1};       ///< u_back_color.
  bool heatMap = false;              ///< Coloured by the mesh's values, without the shader.
};

/// One end of a line, a corner of a triangle, or a point.
struct Mark {
  std::array<float, 3> position{};                        ///< [m]
  std::array<std::uint8_t, 4> color{255, 255, 255, 255};  ///< Red, green, blue, and of glass how little shines through.
  float size = 1;                                         ///< Of a point: its diameter [pixel].
};

/// Coloured lines, points and triangles over the surfaces, as far as those do not hide them.
struct Marks {
  std::vector<Mark> lines;  ///< Two each.
  std::vector<Mark> points;
  std::vector<Mark> triangles;  ///< Three each.
  std::vector<Mark> glass;      ///< Triangles that one sees through, over all else.

  void Clear() {
    for (std::vector<Mark>* marks : {&lines, &points, &triangles, &glass}) marks->clear();
  }
};

struct DrawList {
  Color clearColor{0.25f, 0.25f, 0.25f, 1};
  Mat4 viewProjection;                            ///< u_view_projection
  Vec3 cameraPosition;                            ///< u_cam_pos
  Vec3 lightPosition{0.5, 2, 2};                  ///< u_light_pos
  Vec3 lightIntensity{3, 3, 3};                   ///< u_light_intensity
  Mat4 lightViewProjection;                       ///< u_light_view_projection: what casts shadows, seen from the light.
  int shadowMapSize = 1024;                       ///< Of u_shadow_map [pixel]; 0: no shadows.
  float normalScaling = 2;                        ///< u_normal_scaling
  float heightScaling = 0.1f;                     ///< u_height_scaling
  UniformValues uniforms;                         ///< Parameters that differ from the shader's defaults.
  std::array<std::filesystem::path, 4> textures;  ///< Of u_texture_1..4; empty: the project's own.
  std::vector<DrawItem> items;
  HeatScale heatScale;  ///< Of the items that are heat maps.
  Marks marks;
  double arrowForce = 0;  ///< Of the longest arrow of contact that there may be [N]; 0: none are drawn.
};

}  // namespace percale
