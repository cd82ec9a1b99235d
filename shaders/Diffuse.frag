#version 330

// Lambert's law: light that falls off with the square of the distance and the cosine of the angle
// to the normal. The back of a cloth has the front's normals, as in the course.

uniform vec4 u_color;
uniform vec3 u_light_pos;
uniform vec3 u_light_intensity;

in vec4 v_position;
in vec4 v_normal;
out vec4 out_color;

void main() {
  vec3 toLight = u_light_pos - v_position.xyz;
  vec3 light = u_light_intensity / dot(toLight, toLight);
  float cosine = max(0.0, dot(normalize(v_normal.xyz), normalize(toLight)));
  out_color = vec4(u_color.rgb * light * cosine, 1.0);
}
