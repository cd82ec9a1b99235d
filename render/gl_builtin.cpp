#include "render/gl_builtin.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <utility>

namespace percale {
namespace {

// Light from the eye, and little of it: folds show, colours stay what they are.
constexpr const char* kHeatMapVertex = R"(#version 330
uniform mat4 u_model;
uniform mat4 u_view_projection;
uniform vec3 u_step_colors[3];
in vec4 in_position;
in vec4 in_normal;
in float in_value;
out vec3 v_position;
out vec3 v_normal;
out float v_value;
out vec3 v_step_color;
void main() {
  vec4 position = u_model * in_position;
  v_position = position.xyz;
  v_normal = (u_model * in_normal).xyz;
  v_value = in_value;
  v_step_color = u_step_colors[clamp(int(in_value + 0.5), 0, 2)];
  gl_Position = u_view_projection * position;
}
)";
constexpr const char* kHeatMapFragment = R"(#version 330
uniform vec3 u_cam_pos;
uniform float u_low;
uniform float u_high;
uniform bool u_steps;
uniform vec3 u_map[7];
in vec3 v_position;
in vec3 v_normal;
in float v_value;
in vec3 v_step_color;
out vec4 out_color;
void main() {
  float t = clamp((v_value - u_low) / (u_high - u_low), 0.0, 1.0);
  vec3 color = vec3(0.0);
  for (int power = 6; power >= 0; --power) color = color * t + u_map[power];
  if (u_steps) color = v_step_color;
  float facing = abs(dot(normalize(v_normal), normalize(u_cam_pos - v_position)));
  out_color = vec4(clamp(color, 0.0, 1.0) * (0.6 + 0.4 * facing), 1.0);
}
)";

// A little nearer to the eye, so that what lies on a surface is not lost in it.
constexpr const char* kMarksVertex = R"(#version 330
uniform mat4 u_view_projection;
uniform vec3 u_cam_pos;
uniform float u_scale;
in vec3 in_position;
in vec4 in_color;
in float in_size;
out vec4 v_color;
void main() {
  v_color = in_color;
  gl_PointSize = u_scale * in_size;
  gl_Position = u_view_projection * vec4(mix(in_position, u_cam_pos, 0.004), 1.0);
}
)";
constexpr const char* kMarksFragment = R"(#version 330
uniform bool u_points;
in vec4 v_color;
out vec4 out_color;
void main() {
  if (u_points && length(gl_PointCoord - 0.5) > 0.5) discard;
  out_color = v_color;
}
)";

constexpr int kOrdinaryHeight = 800;  // [pixel] of a picture in which sizes of points are as stated

struct Attribute {
  unsigned location;
  const char* name;
};

GLuint MakeProgram(const char* vertex, const char* fragment, std::initializer_list<Attribute> attributes) {
  const GLuint program = glCreateProgram();
  for (const auto& [stage, text] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // It lives on in the program.
  }
  for (const Attribute& attribute : attributes) glBindAttribLocation(program, attribute.location, attribute.name);
  glLinkProgram(program);
  return program;
}

void SetMatrix(GLuint program, const char* name, const Mat4& matrix) {
  float floats[16];
  std::transform(matrix.m.begin(), matrix.m.end(), floats, [](double m) { return static_cast<float>(m); });
  glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, floats);
}
void SetVector(GLuint program, const char* name, const Vec3& v) {
  glUniform3f(glGetUniformLocation(program, name), float(v.x), float(v.y), float(v.z));
}

}  // namespace

GlBuiltin::~GlBuiltin() {
  if (heatMap_) glDeleteProgram(heatMap_);
  if (!marks_) return;
  glDeleteProgram(marks_);
  glDeleteVertexArrays(1, &vertexArray_);
  glDeleteBuffers(1, &buffer_);
}

void GlBuiltin::UseHeatMap(const DrawList& list, const Mat4& model) {
  if (!heatMap_) {
    heatMap_ = MakeProgram(kHeatMapVertex, kHeatMapFragment,
                           {{0, "in_position"}, {1, "in_normal"}, {kValueAttribute, "in_value"}});
  }
  glUseProgram(heatMap_);
  SetMatrix(heatMap_, "u_view_projection", list.viewProjection);
  SetMatrix(heatMap_, "u_model", model);
  SetVector(heatMap_, "u_cam_pos", list.cameraPosition);
  const auto at = [this](const char* name) { return glGetUniformLocation(heatMap_, name); };
  glUniform1f(at("u_low"), static_cast<float>(list.heatScale.range.low));
  glUniform1f(at("u_high"), static_cast<float>(list.heatScale.range.high));
  glUniform1i(at("u_steps"), list.heatScale.quantity == Quantity::Contact);
  glUniform3fv(at("u_map"), static_cast<GLsizei>(std::size(kViridis)), kViridis[0].data());
  glUniform3fv(at("u_step_colors"), static_cast<GLsizei>(std::size(kContactColors)), kContactColors[0].data());
}

void GlBuiltin::DrawMarks(const DrawList& list, int height) {
  const Marks& marks = list.marks;
  const std::vector<Mark>* const all[] = {&marks.triangles, &marks.lines, &marks.points, &marks.glass};
  constexpr GLenum kPrimitives[] = {GL_TRIANGLES, GL_LINES, GL_POINTS, GL_TRIANGLES};
  GLsizeiptr bytes = 0;
  for (const std::vector<Mark>* each : all) bytes += static_cast<GLsizeiptr>(each->size() * sizeof(Mark));
  if (bytes == 0) return;
  if (!marks_) {
    marks_ = MakeProgram(kMarksVertex, kMarksFragment, {{0, "in_position"}, {1, "in_color"}, {2, "in_size"}});
    glGenVertexArrays(1, &vertexArray_);
    glGenBuffers(1, &buffer_);
    glBindVertexArray(vertexArray_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    const auto offset = [](std::size_t within) { return reinterpret_cast<const void*>(within); };
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Mark), offset(offsetof(Mark, position)));
    glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Mark), offset(offsetof(Mark, color)));
    glVertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, sizeof(Mark), offset(offsetof(Mark, size)));
    for (GLuint i = 0; i < 3; ++i) glEnableVertexAttribArray(i);
  }
  glUseProgram(marks_);
  SetMatrix(marks_, "u_view_projection", list.viewProjection);
  SetVector(marks_, "u_cam_pos", list.cameraPosition);
  const float scale = std::max(1.0f, float(height) / kOrdinaryHeight);
  glUniform1f(glGetUniformLocation(marks_, "u_scale"), scale);

  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, bytes, nullptr, GL_STREAM_DRAW);
  GLsizeiptr first = 0;  // [byte]
  for (const std::vector<Mark>* each : all) {
    const auto size = static_cast<GLsizeiptr>(each->size() * sizeof(Mark));
    glBufferSubData(GL_ARRAY_BUFFER, first, size, each->data());
    first += size;
  }
  glEnable(GL_PROGRAM_POINT_SIZE);
  GLint next = 0;
  for (std::size_t k = 0; k < std::size(all); ++k) {
    const auto count = static_cast<GLsizei>(all[k]->size());
    if (count == 0) continue;
    const bool glass = all[k] == &marks.glass;
    if (glass) {
      glEnable(GL_BLEND);
      glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
      glDepthMask(GL_FALSE);
    }
    glUniform1i(glGetUniformLocation(marks_, "u_points"), kPrimitives[k] == GL_POINTS);
    glDrawArrays(kPrimitives[k], next, count);
    if (glass) {
      glDepthMask(GL_TRUE);
      glDisable(GL_BLEND);
    }
    next += count;
  }
  glDisable(GL_PROGRAM_POINT_SIZE);
}

}  // namespace percale
