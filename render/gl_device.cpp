#include "render/gl_device.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <utility>

#include "io/atomic_file.h"
#include "render/gl_builtin.h"
#include "render/gl_shadow_map.h"
#include "render/gl_textures.h"

namespace percale {
namespace {

constexpr int kFirstTextureUnit = 1;  // u_texture_1..4 on units 1..4, as in the course.
constexpr int kCubeMapUnit = 5;
constexpr int kShadowMapUnit = 6;
constexpr float kShadowSlopeOffset = 1.5f, kShadowOffset = 2;  // As glPolygonOffset takes them.

// Draws the shadow map, and stands in for a shader that does not compile.
constexpr const char* kPlainVertex = R"(#version 330
uniform mat4 u_model;
uniform mat4 u_view_projection;
in vec4 in_position;
void main() { gl_Position = u_view_projection * (u_model * in_position); }
)";
constexpr const char* kPlainFragment = R"(#version 330
out vec4 out_color;
void main() { out_color = vec4(1.0, 0.0, 1.0, 1.0); }
)";

std::array<float, 16> ToFloats(const Mat4& matrix) {
  std::array<float, 16> floats;
  for (std::size_t i = 0; i < 16; ++i) floats[i] = static_cast<float>(matrix.m[i]);
  return floats;
}

// The buffers of one DrawMesh.
struct GpuMesh {
  enum { Positions, Normals, Uv, Tangents, Values, Triangles, Lines, BufferCount };
  std::weak_ptr<const DrawMesh> source;
  GLuint vertexArrays[2] = {};  // Of the triangles, and of the lines: they differ by their index buffer.
  GLuint buffers[BufferCount] = {};
  std::uint64_t shapeVersion = 0, meshVersion = 0;
  bool isFilled = false;
  bool hasValues = false;
};

class MeshStore {
 public:
  ~MeshStore() {
    for (auto& [key, mesh] : meshes_) Delete(mesh);
  }

  const GpuMesh& Get(const std::shared_ptr<const DrawMesh>& source) {
    GpuMesh& mesh = meshes_[source.get()];
    if (mesh.source.expired()) {  // A new mesh, perhaps at the address of an old one.
      mesh.source = source;
      mesh.isFilled = false;
    }
    if (!mesh.vertexArrays[0]) Create(mesh);
    const bool newMesh = !mesh.isFilled || mesh.meshVersion != source->meshVersion;
    if (newMesh) {
      Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Uv], source->uv, GL_STATIC_DRAW);
      // An index buffer belongs to the vertex array that is bound: none, while it is filled.
      glBindVertexArray(0);
      Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Triangles], source->triangles, GL_STATIC_DRAW);
      Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Lines], source->lines, GL_STATIC_DRAW);
    }
    if (newMesh || mesh.shapeVersion != source->shapeVersion) {
      Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Positions], source->positions, GL_STREAM_DRAW);
      Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Normals], source->normals, GL_STREAM_DRAW);
      Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Tangents], source->tangents, GL_STREAM_DRAW);
      if (!source->values.empty()) Fill(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Values], source->values, GL_STREAM_DRAW);
      if (mesh.hasValues == source->values.empty()) EnableValues(mesh, !source->values.empty());
    }
    mesh.meshVersion = source->meshVersion;
    mesh.shapeVersion = source->shapeVersion;
    mesh.isFilled = true;
    return mesh;
  }

  void DropUnused() {
    for (auto it = meshes_.begin(); it != meshes_.end();) {
      if (it->second.source.expired()) {
        Delete(it->second);
        it = meshes_.erase(it);
      } else {
        ++it;
      }
    }
  }

 private:
  template <class T>
  static void Fill(GLenum target, GLuint buffer, const std::vector<T>& data, GLenum usage) {
    glBindBuffer(target, buffer);
    // With new storage of the same size the driver need not wait for the last frame to be drawn.
    glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), usage);
  }

  // Without values every vertex has the value 0.
  static void EnableValues(GpuMesh& mesh, bool enable) {
    for (const GLuint vertexArray : mesh.vertexArrays) {
      glBindVertexArray(vertexArray);
      if (enable) {
        glBindBuffer(GL_ARRAY_BUFFER, mesh.buffers[GpuMesh::Values]);
        glVertexAttribPointer(GlBuiltin::kValueAttribute, 1, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(GlBuiltin::kValueAttribute);
      } else {
        glDisableVertexAttribArray(GlBuiltin::kValueAttribute);
      }
    }
    mesh.hasValues = enable;
  }

  static void Create(GpuMesh& mesh) {
    glGenVertexArrays(2, mesh.vertexArrays);
    glGenBuffers(GpuMesh::BufferCount, mesh.buffers);
    const struct {
      int buffer;
      GLint size;
    } attributes[] = {{GpuMesh::Positions, 3}, {GpuMesh::Normals, 4}, {GpuMesh::Uv, 2}, {GpuMesh::Tangents, 4}};
    for (int kind = 0; kind < 2; ++kind) {
      glBindVertexArray(mesh.vertexArrays[kind]);
      for (GLuint i = 0; i < 4; ++i) {
        glBindBuffer(GL_ARRAY_BUFFER, mesh.buffers[attributes[i].buffer]);
        // A position's fourth component is 1 by OpenGL's default, as the course's shaders expect.
        glVertexAttribPointer(i, attributes[i].size, GL_FLOAT, GL_FALSE, 0, nullptr);
        glEnableVertexAttribArray(i);
      }
      glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.buffers[kind == 0 ? GpuMesh::Triangles : GpuMesh::Lines]);
    }
    glBindVertexArray(0);
  }

  static void Delete(GpuMesh& mesh) {
    glDeleteVertexArrays(2, mesh.vertexArrays);
    glDeleteBuffers(GpuMesh::BufferCount, mesh.buffers);
  }

  std::map<const DrawMesh*, GpuMesh> meshes_;
};

GLuint MakePlain() {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] :
       {std::pair{GL_VERTEX_SHADER, kPlainVertex}, std::pair{GL_FRAGMENT_SHADER, kPlainFragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // It lives on in the program.
  }
  glBindAttribLocation(program, 0, "in_position");
  glLinkProgram(program);
  return program;
}

}  // namespace

GraphicsInfo DescribeGraphics() {
  const auto text = [](GLenum name) {
    const auto* value = reinterpret_cast<const char*>(glGetString(name));
    return std::string(value ? value : "");
  };
  GraphicsInfo info{text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION), false, 1};
  std::string lower = info.renderer;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const char* name :
       {"llvmpipe", "softpipe", "swrast", "swiftshader", "software", "gdi generic", "basic render"}) {
    info.software |= lower.find(name) != std::string::npos;
  }
  GLint samples = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &samples);
  info.maxSamples = std::max(1, samples);
  return info;
}

struct GlDevice::Impl {
  explicit Impl(const std::filesystem::path& root) : shaders(root / "shaders"), textures(root / "textures") {}
  ~Impl() {
    if (plain) glDeleteProgram(plain);
  }

  void DrawShadowMap(const DrawList& list);
  void UsePlain(const Mat4& viewProjection);
  void SetUniforms(const ShaderProgram& shader, const DrawList& list);
  void Draw(const DrawItem& item, const ShaderProgram* shader);
  void DrawMesh(const DrawItem& item);

  ShaderLibrary shaders;
  GlTextures textures;
  MeshStore meshes;
  GlShadowMap shadowMap;
  GlBuiltin builtin;
  GLuint plain = 0;
};

GlDevice::GlDevice(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlDevice::~GlDevice() = default;
GlDevice::GlDevice(GlDevice&&) noexcept = default;
GlDevice& GlDevice::operator=(GlDevice&&) noexcept = default;

Result<GlDevice> GlDevice::Create(const std::filesystem::path& root) {
  if (epoxy_gl_version() < 33) {
    const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    return MakeError("expected OpenGL 3.3 or newer, found " + std::string(version ? version : "none") +
                     "; update the graphics driver, or use the CPU driver (libgl1-mesa-dri on Debian)");
  }
  auto impl = std::make_unique<Impl>(root);
  if (impl->shaders.names().empty()) {
    return MakeError(PathText(root / "shaders"),
                     "expected the folder of the shaders (*.frag), found none; name the project folder with -r DIR");
  }
  return GlDevice(std::move(impl));
}

ShaderLibrary& GlDevice::shaders() {
  return impl_->shaders;
}

std::vector<std::filesystem::path> GlDevice::TextureFiles() const {
  return impl_->textures.Files();
}

std::vector<std::filesystem::path> GlDevice::ReloadTextures(const std::vector<std::filesystem::path>& files) {
  return impl_->textures.Reload(files);
}

Diagnostics GlDevice::TakeWarnings() {
  Diagnostics warnings = impl_->textures.TakeWarnings();
  const Diagnostics more = impl_->shadowMap.TakeWarnings();
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

void GlDevice::Impl::UsePlain(const Mat4& viewProjection) {
  if (!plain) plain = MakePlain();
  glUseProgram(plain);
  glUniformMatrix4fv(glGetUniformLocation(plain, "u_view_projection"), 1, GL_FALSE, ToFloats(viewProjection).data());
}

// What the light reaches, where a shader asks for it. A vertex shader that moves its surface casts
// the shadow of the surface as it was.
void GlDevice::Impl::DrawShadowMap(const DrawList& list) {
  const bool isWanted = std::any_of(list.items.begin(), list.items.end(), [&](const DrawItem& item) {
    const ShaderProgram* shader = shaders.Find(item.shader, item.surface);
    return shader && shader->Location("u_shadow_map") >= 0;
  });
  if (!isWanted) return;
  shadowMap.Clear();
  if (list.shadowMapSize < 1 || !shadowMap.Begin(list.shadowMapSize)) return;
  UsePlain(list.lightViewProjection);
  // Away from the light, by more where the surface is steep: else it would lie in its own shadow.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kShadowSlopeOffset, kShadowOffset);
  for (const DrawItem& item : list.items) {
    if (item.castsShadow) Draw(item, nullptr);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  shadowMap.End();
}

// Everything that is the same for all items of a shader. `shader` is the program in use.
void GlDevice::Impl::SetUniforms(const ShaderProgram& shader, const DrawList& list) {
  const auto at = [&](std::string_view name) { return shader.Location(name); };
  const auto setVec3 = [&](std::string_view name, const Vec3& v) {
    if (at(name) >= 0) glUniform3f(at(name), float(v.x), float(v.y), float(v.z));
  };
  if (at("u_view_projection") >= 0) {
    glUniformMatrix4fv(at("u_view_projection"), 1, GL_FALSE, ToFloats(list.viewProjection).data());
  }
  if (at("u_light_view_projection") >= 0) {
    glUniformMatrix4fv(at("u_light_view_projection"), 1, GL_FALSE, ToFloats(list.lightViewProjection).data());
  }
  setVec3("u_cam_pos", list.cameraPosition);
  setVec3("u_light_pos", list.lightPosition);
  setVec3("u_light_intensity", list.lightIntensity);
  if (at("u_normal_scaling") >= 0) glUniform1f(at("u_normal_scaling"), list.normalScaling);
  if (at("u_height_scaling") >= 0) glUniform1f(at("u_height_scaling"), list.heightScaling);

  for (int i = 0; i < 4; ++i) {
    const std::string name = "u_texture_" + std::to_string(i + 1);
    const int sampler = at(name), size = at(name + "_size");
    if (sampler < 0 && size < 0) continue;
    const GlTextures::Texture& texture = textures.Get(i, list.textures[static_cast<std::size_t>(i)]);
    if (sampler >= 0) {
      glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + kFirstTextureUnit + i));
      glBindTexture(GL_TEXTURE_2D, texture.name);
      glUniform1i(sampler, kFirstTextureUnit + i);
    }
    if (size >= 0) glUniform2f(size, float(texture.width), float(texture.height));
  }
  if (const int sampler = at("u_texture_cubemap"); sampler >= 0) {
    const unsigned cubeMap = textures.CubeMap();
    glActiveTexture(GL_TEXTURE0 + kCubeMapUnit);
    glBindTexture(GL_TEXTURE_CUBE_MAP, cubeMap);
    glUniform1i(sampler, kCubeMapUnit);
  }
  if (const int sampler = at("u_shadow_map"); sampler >= 0) {
    const unsigned texture = shadowMap.Texture();
    glActiveTexture(GL_TEXTURE0 + kShadowMapUnit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glUniform1i(sampler, kShadowMapUnit);
  }

  for (const ShaderParameter& parameter : shader.parameters) {
    const int location = at(parameter.name);
    if (location < 0) continue;
    const auto given = list.uniforms.find(parameter.name);
    const UniformValue& value = given != list.uniforms.end() ? given->second : parameter.defaultValue;
    switch (parameter.type) {
      case ShaderParameter::Type::Float:
        glUniform1f(location, value[0]);
        break;
      case ShaderParameter::Type::Int:
        glUniform1i(location, static_cast<GLint>(value[0]));
        break;
      case ShaderParameter::Type::Bool:
        glUniform1i(location, value[0] != 0);
        break;
      case ShaderParameter::Type::Vector:
        glUniform3f(location, value[0], value[1], value[2]);
        break;
    }
  }
}

// With the program in use: that of `shader`, or the plain one.
void GlDevice::Impl::Draw(const DrawItem& item, const ShaderProgram* shader) {
  const bool isLines = item.primitive == DrawItem::Primitive::Lines;
  const std::array<float, 16> model = ToFloats(item.model);
  if (shader) {
    if (shader->Location("u_model") >= 0) glUniformMatrix4fv(shader->Location("u_model"), 1, GL_FALSE, model.data());
    if (shader->Location("u_color") >= 0) glUniform4fv(shader->Location("u_color"), 1, item.color.data());
    if (shader->Location("u_back_color") >= 0) glUniform4fv(shader->Location("u_back_color"), 1, item.backColor.data());
    if (shader->Location("u_lines") >= 0) glUniform1i(shader->Location("u_lines"), isLines);
  } else {
    glUniformMatrix4fv(glGetUniformLocation(plain, "u_model"), 1, GL_FALSE, model.data());
  }
  DrawMesh(item);
}

// With the program in use.
void GlDevice::Impl::DrawMesh(const DrawItem& item) {
  const bool isLines = item.primitive == DrawItem::Primitive::Lines;
  const auto count = static_cast<GLsizei>(isLines ? item.mesh->lines.size() : item.mesh->triangles.size());
  if (count == 0) return;
  const GpuMesh& mesh = meshes.Get(item.mesh);
  if (item.pushBack) {
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
  }
  if (item.surface == Surface::Background) {  // Behind everything.
    glDepthRange(1, 1);
    glDepthFunc(GL_LEQUAL);
  }
  glBindVertexArray(mesh.vertexArrays[isLines ? 1 : 0]);
  glDrawElements(isLines ? GL_LINES : GL_TRIANGLES, count, GL_UNSIGNED_INT, nullptr);
  if (item.surface == Surface::Background) {
    glDepthRange(0, 1);
    glDepthFunc(GL_LESS);
  }
  if (item.pushBack) glDisable(GL_POLYGON_OFFSET_FILL);
}

Status GlDevice::Draw(const DrawList& list, int width, int height) {
  Diagnostics problems;
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);  // A cloth shows both sides; the back is shaded with the front's normals, as in the course.
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glEnable(GL_MULTISAMPLE);
  // The course draws without conversion: what a shader writes is what the screen shows.
  glDisable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  impl_->DrawShadowMap(list);
  glViewport(0, 0, width, height);
  glClearColor(list.clearColor[0], list.clearColor[1], list.clearColor[2], list.clearColor[3]);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

  const DrawItem* previous = nullptr;
  const ShaderProgram* shader = nullptr;
  for (const DrawItem& item : list.items) {
    if (item.heatMap) {
      impl_->builtin.UseHeatMap(list, item.model);
      impl_->DrawMesh(item);
      previous = nullptr;
      continue;
    }
    if (!previous || previous->shader != item.shader || previous->surface != item.surface) {
      previous = &item;
      shader = impl_->shaders.Find(item.shader, item.surface);
      if (shader) {
        glUseProgram(shader->program);
        impl_->SetUniforms(*shader, list);
      } else if (const Diagnostics& found = impl_->shaders.Problems(item.shader); HasErrors(found)) {
        const bool isNew = std::none_of(problems.begin(), problems.end(), [&](const Diagnostic& d) {
          return d.message == found.front().message && d.place.file == found.front().place.file;
        });
        if (isNew) problems.insert(problems.end(), found.begin(), found.end());
        impl_->UsePlain(list.viewProjection);
      }
    }
    if (shader || item.surface != Surface::Background) impl_->Draw(item, shader);
  }
  impl_->builtin.DrawMarks(list, height);
  glBindVertexArray(0);
  glUseProgram(0);
  glActiveTexture(GL_TEXTURE0);
  impl_->meshes.DropUnused();
  if (HasErrors(problems)) return problems;
  return Ok();
}

}  // namespace percale
