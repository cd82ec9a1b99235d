#version 330

// Spheres and other solids in the house look: glazed ceramic.

#include "house_light.glsl"

uniform vec3 u_ball;  // @color @default 0.88 0.86 0.83 @label Balls @help Colour of spheres
uniform vec4 u_back_color;  // A collider's own colour.

in vec4 v_position;
in vec4 v_normal;
out vec4 out_color;

void main() {
  vec3 v = normalize(u_cam_pos - v_position.xyz), n = normalize(v_normal.xyz);
  vec3 l = normalize(u_light_pos - v_position.xyz), h = normalize(l + v);
  Light light = lightAt(v_position.xyz, n, n);
  float nv = clamp(dot(n, v), 0.0, 1.0), nl = max(0.0, dot(n, l));
  // Schlick 1994, for a glaze of index 1.5.
  float fresnel = 0.04 + 0.96 * pow(1.0 - nv, 5.0);
  vec3 color = (1.0 - fresnel) * toLinear(u_ball * u_back_color.rgb) * (light.lamp * nl + light.open * light.fill);
  color += light.open * fresnel * surroundings(reflect(-v, n), 3.5);
  color += light.lamp * nl * 0.6 * pow(max(0.0, dot(n, h)), 180.0);
  out_color = vec4(toDisplay(color), 1.0);
}
