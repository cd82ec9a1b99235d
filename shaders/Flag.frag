#version 330

// A flag of two or three bands, by the position in the world: the bands stay where they are while
// the cloth moves through them. By default that of Ukraine.

uniform vec3 u_light_pos;
uniform vec3 u_light_intensity;

uniform int u_axis;     // @choices Horizontal|Vertical @default 0 @label Bands
uniform int u_bands;    // @range 2 3 @default 2 @label Number of bands
uniform vec3 u_band_1;  // @color @default 0 0.341 0.718 @label First band @help The upper or left one
uniform vec3 u_band_2;  // @color @default 1 0.843 0 @label Second band
uniform vec3 u_band_3;  // @color @default 0.8 0.1 0.15 @label Third band
uniform float u_from;   // @range -2 2 @default 0 @label Flag from @help Lower or left end of the flag [m]
uniform float u_to;     // @range -2 2 @default 1 @label Flag to @help Upper or right end of the flag [m]
uniform bool u_lit;     // @default 1 @label Diffuse light

in vec4 v_position;
in vec4 v_normal;
out vec4 out_color;

void main() {
  float along = u_axis == 1 ? v_position.x - u_from : u_to - v_position.y;
  float band = along / (u_to - u_from) * float(u_bands);
  // One pixel wide, the bands mix: multisampling does not smooth what happens inside a triangle.
  float pixel = max(fwidth(band), 1e-6);
  vec3 color = mix(u_band_1, u_band_2, clamp((band - 1.0) / pixel + 0.5, 0.0, 1.0));
  if (u_bands > 2) color = mix(color, u_band_3, clamp((band - 2.0) / pixel + 0.5, 0.0, 1.0));
  if (u_lit) {
    vec3 toLight = u_light_pos - v_position.xyz;
    // Cloth lets light through: the side away from the light is dimmer, not black.
    float cosine = dot(normalize(v_normal.xyz), normalize(toLight));
    color *= 0.4 + u_light_intensity / dot(toLight, toLight) * (cosine > 0.0 ? cosine : -0.4 * cosine);
  }
  out_color = vec4(color, 1.0);
}
