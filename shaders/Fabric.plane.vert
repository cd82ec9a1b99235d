#version 330

// The ground reaches further than the square that stands for a plane, and fades.

uniform mat4 u_model;
uniform mat4 u_view_projection;

in vec4 in_position;
in vec4 in_normal;
in vec2 in_uv;
in vec4 in_tangent;

out vec4 v_position;
out vec4 v_normal;
out vec2 v_square;  // -1 to 1 over the square, beyond that outside of it.

const float kReach = 2.5;  // Times the size of the square.

void main() {
  v_square = kReach * (2.0 * in_uv - 1.0);
  v_normal = normalize(u_model * in_normal);
  vec3 right = (u_model * in_tangent).xyz;
  vec3 up = cross(v_normal.xyz, right);
  vec3 corner = (2.0 * in_uv.x - 1.0) * right + (1.0 - 2.0 * in_uv.y) * up;
  v_position = u_model * in_position;
  v_position.xyz += 2.0 * (kReach - 1.0) * corner;  // The square is 4 m wide.
  gl_Position = u_view_projection * v_position;
}
