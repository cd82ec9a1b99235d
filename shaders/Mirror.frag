#version 330

// A perfect mirror of the surroundings, which are infinitely far away.

uniform vec3 u_cam_pos;
uniform samplerCube u_texture_cubemap;

in vec4 v_position;
in vec4 v_normal;
out vec4 out_color;

void main() {
  vec3 fromEye = normalize(v_position.xyz - u_cam_pos);
  vec3 reflected = reflect(fromEye, normalize(v_normal.xyz));
  out_color = vec4(texture(u_texture_cubemap, reflected).rgb, 1.0);
}
