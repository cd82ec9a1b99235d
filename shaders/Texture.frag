#version 330

// A picture laid over the cloth, with no light.

uniform sampler2D u_texture_1;
uniform sampler2D u_texture_2;
uniform sampler2D u_texture_3;
uniform sampler2D u_texture_4;

uniform int u_texture_number;  // @choices Texture 1|Texture 2|Texture 3|Texture 4 @default 0 @label Picture
uniform float u_repeat;        // @range 1 16 @default 1 @label Repeats @help How often the picture fits along each side

in vec2 v_uv;
out vec4 out_color;

void main() {
  vec2 uv = u_repeat * v_uv;
  if (u_texture_number == 1) out_color = texture(u_texture_2, uv);
  else if (u_texture_number == 2) out_color = texture(u_texture_3, uv);
  else if (u_texture_number == 3) out_color = texture(u_texture_4, uv);
  else out_color = texture(u_texture_1, uv);
  out_color.a = 1.0;
}
