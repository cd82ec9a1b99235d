#version 330

// Bump mapping: Blinn-Phong with a normal that the slope of a height map tilts. The surface itself
// stays smooth. Heights are the red channel.

uniform vec4 u_color;
uniform vec3 u_cam_pos;
uniform vec3 u_light_pos;
uniform vec3 u_light_intensity;
uniform float u_normal_scaling;
uniform float u_height_scaling;

uniform sampler2D u_texture_1;
uniform sampler2D u_texture_2;
uniform sampler2D u_texture_3;
uniform sampler2D u_texture_4;
uniform vec2 u_texture_1_size;
uniform vec2 u_texture_2_size;
uniform vec2 u_texture_3_size;
uniform vec2 u_texture_4_size;

uniform int u_height_map;  // @choices Texture 1|Texture 2|Texture 3|Texture 4 @default 2 @label Height map

in vec4 v_position;
in vec4 v_normal;
in vec4 v_tangent;
in vec2 v_uv;
out vec4 out_color;

float height(vec2 uv) {
  if (u_height_map == 0) return texture(u_texture_1, uv).r;
  if (u_height_map == 1) return texture(u_texture_2, uv).r;
  if (u_height_map == 3) return texture(u_texture_4, uv).r;
  return texture(u_texture_3, uv).r;
}

vec2 mapSize() {
  if (u_height_map == 0) return u_texture_1_size;
  if (u_height_map == 1) return u_texture_2_size;
  if (u_height_map == 3) return u_texture_4_size;
  return u_texture_3_size;
}

// The surface's normal, tilted against the slope.
vec3 bumpNormal() {
  vec3 n = normalize(v_normal.xyz);
  vec3 across = v_tangent.xyz - dot(v_tangent.xyz, n) * n;
  // A constant tangent can be parallel to the normal: any direction at a right angle will do.
  vec3 t = dot(across, across) > 1e-6 ? normalize(across) : normalize(cross(n, abs(n.y) < 0.9 ? vec3(0, 1, 0) : vec3(0, 0, 1)));
  vec3 b = cross(n, t);
  // On some meshes v grows to one side of u, on others to the other; the bitangent follows v.
  vec3 px = dFdx(v_position.xyz), py = dFdy(v_position.xyz);
  vec2 ux = dFdx(v_uv), uy = dFdy(v_uv);
  if (dot(cross(px, py), n) * (ux.x * uy.y - ux.y * uy.x) < 0.0) b = -b;

  vec2 size = mapSize();
  float here = height(v_uv);
  float du = (height(v_uv + vec2(1.0 / size.x, 0.0)) - here) * u_height_scaling * u_normal_scaling;
  float dv = (height(v_uv + vec2(0.0, 1.0 / size.y)) - here) * u_height_scaling * u_normal_scaling;
  return normalize(n - du * t - dv * b);
}

void main() {
  vec3 n = bumpNormal();
  vec3 toLight = u_light_pos - v_position.xyz;
  vec3 light = u_light_intensity / dot(toLight, toLight);
  vec3 l = normalize(toLight);
  vec3 h = normalize(l + normalize(u_cam_pos - v_position.xyz));
  vec3 color = 0.1 * u_color.rgb;
  color += u_color.rgb * light * max(0.0, dot(n, l));
  color += 0.5 * light * pow(max(0.0, dot(n, h)), 64.0);
  out_color = vec4(color, 1.0);
}
