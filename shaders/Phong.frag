#version 330

// Blinn-Phong: ambient, diffuse and specular light, each of which can be switched off.

uniform vec4 u_color;
uniform vec3 u_cam_pos;
uniform vec3 u_light_pos;
uniform vec3 u_light_intensity;

uniform bool u_ambient_on;   // @default 1 @label Ambient @help Light that reaches every point alike
uniform bool u_diffuse_on;   // @default 1 @label Diffuse @help Light scattered by a matt surface
uniform bool u_specular_on;  // @default 1 @label Specular @help The light's reflection in a glossy surface
uniform float u_ambient;     // @range 0 1 @default 0.1 @label Ambient strength
uniform float u_diffuse;     // @range 0 1 @default 1 @label Diffuse strength
uniform float u_specular;    // @range 0 1 @default 0.5 @label Specular strength
uniform float u_shininess;   // @range 1 256 @default 64 @label Shininess @help The exponent: the larger, the smaller the highlight

in vec4 v_position;
in vec4 v_normal;
out vec4 out_color;

void main() {
  vec3 n = normalize(v_normal.xyz);
  vec3 toLight = u_light_pos - v_position.xyz;
  vec3 light = u_light_intensity / dot(toLight, toLight);
  vec3 l = normalize(toLight);
  vec3 h = normalize(l + normalize(u_cam_pos - v_position.xyz));
  float cosine = dot(n, l);

  vec3 color = vec3(0.0);
  if (u_ambient_on) color += u_ambient * u_color.rgb;
  if (u_diffuse_on) color += u_diffuse * u_color.rgb * light * max(0.0, cosine);
  if (u_specular_on) color += u_specular * light * pow(max(0.0, dot(n, h)), u_shininess);
  out_color = vec4(color, 1.0);
}
