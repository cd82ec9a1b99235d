#version 330

// Planes in the house look: paper that runs on into the background, and catches shadows.

#include "house_light.glsl"

uniform vec3 u_ground;  // @color @default 1 1 1 @label Ground @help Colour of planes, times the backdrop's

in vec4 v_position;
in vec4 v_normal;
in vec2 v_square;
out vec4 out_color;

void main() {
  vec3 ray = normalize(v_position.xyz - u_cam_pos), n = normalize(v_normal.xyz);
  if (dot(n, ray) > 0.0) n = -n;
  vec3 l = normalize(u_light_pos - v_position.xyz);
  Light light = lightAt(v_position.xyz, n, n);
  // As bright as the background where it is level and nothing is in the way of the light.
  vec3 level = lampLight(v_position.xyz) * max(0.1, l.y) + light.fill;
  vec3 relative = (light.lamp * max(0.0, dot(n, l)) + light.open * light.fill) / level;
  float fade = smoothstep(0.8, 2.3, length(v_square));
  out_color = vec4(toDisplay(backdrop(ray) * mix(toLinear(u_ground) * relative, vec3(1.0), fade)), 1.0);
}
