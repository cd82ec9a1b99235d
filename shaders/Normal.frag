#version 330

// The normal as a colour: -1..1 of x, y, z become 0..1 of red, green, blue.

in vec4 v_normal;
out vec4 out_color;

void main() {
  out_color = vec4(0.5 * (normalize(v_normal.xyz) + 1.0), 1.0);
}
