#version 330

// The background in the house look: a paper roll in a studio.

#include "house_light.glsl"

in vec4 v_position;
out vec4 out_color;

void main() {
  out_color = vec4(toDisplay(backdrop(normalize(v_position.xyz - u_cam_pos))), 1.0);
}
