#version 330

// Displacement mapping: a height map moves the vertices along their normals, u_height_scaling metres
// for white. Its fragment shader tilts the normals to match.

uniform mat4 u_model;
uniform mat4 u_view_projection;
uniform float u_height_scaling;

uniform sampler2D u_texture_1;
uniform sampler2D u_texture_2;
uniform sampler2D u_texture_3;
uniform sampler2D u_texture_4;

uniform int u_height_map;  // @choices Texture 1|Texture 2|Texture 3|Texture 4 @default 2 @label Height map

in vec4 in_position;
in vec4 in_normal;
in vec2 in_uv;
in vec4 in_tangent;

out vec4 v_position;
out vec4 v_normal;
out vec4 v_tangent;
out vec2 v_uv;

float height(vec2 uv) {
  if (u_height_map == 0) return textureLod(u_texture_1, uv, 0.0).r;
  if (u_height_map == 1) return textureLod(u_texture_2, uv, 0.0).r;
  if (u_height_map == 3) return textureLod(u_texture_4, uv, 0.0).r;
  return textureLod(u_texture_3, uv, 0.0).r;
}

void main() {
  v_normal = normalize(u_model * in_normal);
  v_tangent = normalize(u_model * in_tangent);
  v_uv = in_uv;
  v_position = u_model * in_position;
  v_position.xyz += height(in_uv) * u_height_scaling * v_normal.xyz;
  gl_Position = u_view_projection * v_position;
}
