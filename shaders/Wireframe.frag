#version 330

// Springs as lines of the base colour. Spheres and planes are drawn as surfaces, darker than the
// lines and shaded from the eye, so that both show.

uniform vec4 u_color;
uniform vec3 u_cam_pos;
uniform bool u_lines;  // Set by the program while it draws lines.

uniform bool u_shade_colliders;  // @default 1 @label Shade colliders @help Off: spheres and planes in their plain colour, as in the course

in vec4 v_position;
in vec4 v_normal;
out vec4 out_color;

void main() {
  float shade = 1.0;
  if (!u_lines && u_shade_colliders) {
    vec3 toEye = normalize(u_cam_pos - v_position.xyz);
    shade = 0.25 + 0.4 * abs(dot(normalize(v_normal.xyz), toEye));
  }
  out_color = vec4(shade * u_color.rgb, 1.0);
}
