// The light of the house look, shared by the parts of Fabric. All of it computes with linear light;
// toDisplay makes the colour of a pixel of it.

uniform vec3 u_cam_pos;
uniform vec3 u_light_pos;
uniform vec3 u_light_intensity;
uniform mat4 u_light_view_projection;
uniform sampler2DShadow u_shadow_map;
uniform samplerCube u_texture_cubemap;

uniform float u_key;        // @range 0 4 @default 1.15 @label Key light @help Strength of the lamp
uniform float u_fill;       // @range 0 2 @default 0.42 @label Fill light @help Strength of the light from all around
uniform float u_softness;   // @range 0 0.1 @default 0.022 @label Shadow softness @help Width of the edges of shadows [m]
uniform int u_shadow_taps;  // @range 1 64 @default 16 @label Shadow taps @help Samples for a soft shadow: more are smoother and slower
uniform float u_exposure;   // @range 0.1 4 @default 1 @label Exposure
uniform vec3 u_backdrop;    // @color @default 0.86 0.86 0.855 @label Backdrop @help Colour of the background

const float kPi = 3.14159265;

vec3 toLinear(vec3 srgb) {
  return mix(srgb / 12.92, pow((srgb + 0.055) / 1.055, vec3(2.4)), step(0.04045, srgb));
}

float luminance(vec3 linear) {
  return dot(linear, vec3(0.2126, 0.7152, 0.0722));
}

// Tone mapping that leaves colours below 0.76 as they are and rolls off what is brighter: Khronos
// Group 2024, "PBR Neutral Tone Mapper". Then sRGB (IEC 61966-2-1).
vec3 toDisplay(vec3 linear) {
  vec3 color = u_exposure * linear;
  float least = min(color.r, min(color.g, color.b));
  color -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  float peak = max(color.r, max(color.g, color.b));
  if (peak > 0.76) {
    float rolled = 1.0 - 0.0576 / (peak - 0.52);
    color *= rolled / peak;
    color = mix(vec3(rolled), color, 1.0 / (0.15 * (peak - rolled) + 1.0));
  }
  color = max(color, 0.0);
  return mix(12.92 * color, 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, color));
}

// A fixed number in 0..1 for each pixel, unlike those of its neighbours: Jimenez 2014, "Next
// generation post processing in Call of Duty: Advanced Warfare".
float pixelNoise() {
  return fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
}

// How much of the lamp a point sees, 0..1, with edges of shadows that are `radius` metres wide to each
// side. Percentage-closer filtering (Reeves et al. 1987) over a sunflower disk (Vogel 1979) that lies
// in the surface, whose normal `side` is, and is turned by another angle in each pixel. Since the
// disk lies in the surface, no tap is compared with a depth that the surface does not have, and a
// steep surface does not shade itself.
float visibility(vec3 position, vec3 side, float radius) {
  vec3 t = normalize(cross(side, abs(side.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  float lift = 0.003 + 0.2 * radius;  // Above the hollows of a curved surface.
  vec4 center = u_light_view_projection * vec4(position + lift * side, 1.0);
  vec4 across = u_light_view_projection * vec4(radius * t, 0.0);
  vec4 along = u_light_view_projection * vec4(radius * cross(side, t), 0.0);
  // Nothing stands between the lamp and what lies outside of the map, or behind the lamp.
  vec2 reach = abs(across.xy) + abs(along.xy);
  bool inside = all(lessThan(abs(center.xy) - reach, vec2(center.w)));
  float turn = 2.0 * kPi * pixelNoise(), sum = 0.0, count = 0.0;
  for (int k = 0; k < u_shadow_taps && inside; ++k) {
    // From the middle and from the rim in turn: where the first six agree, which is most of the
    // picture, the others are spared.
    float i = float(k % 2 == 0 ? k / 2 : u_shadow_taps - 1 - k / 2);
    float distance = sqrt((i + 0.5) / float(u_shadow_taps)), angle = 2.39996323 * i + turn;
    vec4 clip = center + distance * (cos(angle) * across + sin(angle) * along);
    vec3 map = 0.5 * clip.xyz / clip.w + 0.5;
    sum += textureLod(u_shadow_map, vec3(map.xy, min(map.z, 1.0)), 0.0);
    count += 1.0;
    if (count == 6.0 && (sum == 0.0 || sum == 6.0)) break;
  }
  return count > 0.0 ? sum / count : 1.0;
}

// The light that reaches a point: of the lamp, and from all around. Where something is near on the
// lamp's side, only a share of the surroundings is open to the point.
struct Light {
  vec3 lamp, fill;
  float open;
};

// The surroundings, blurred: `blur` is a level of detail, 0 for a mirror. Calmer than they are, as
// in a studio, whose floor hides what is below.
vec3 surroundings(vec3 direction, float blur) {
  vec3 sky = toLinear(textureLod(u_texture_cubemap, direction, blur).rgb);
  return mix(toLinear(u_backdrop), mix(vec3(luminance(sky)), sky, 0.3), smoothstep(-0.15, 0.15, direction.y));
}

// From all around: the white walls of a studio, brighter above than below, and the surroundings,
// blurred to a hemisphere.
vec3 fillLight(vec3 n) {
  vec3 walls = mix(vec3(0.48, 0.46, 0.44), vec3(0.98, 1.0, 1.04), 0.5 + 0.5 * n.y);
  return u_fill * (0.6 * walls + 0.4 * surroundings(n, 6.0));
}

// The lamp is large: its light falls off slowly, and equals the course's at 2 m, where it mostly is.
vec3 lampLight(vec3 position) {
  return u_key * vec3(1.02, 1.0, 0.97) * u_light_intensity / (2.0 * length(u_light_pos - position));
}

// `side` is the normal of the side to look from: a thin sheet shines through, and must not shade
// itself, so it looks from the lamp's side.
Light lightAt(vec3 position, vec3 n, vec3 side) {
  Light light;
  light.lamp = lampLight(position) * visibility(position, side, u_softness);
  light.fill = fillLight(n);
  light.open = mix(0.5, 1.0, visibility(position, side, 5.0 * u_softness));
  return light;
}

// What is behind everything: a roll of paper, paler below the height of the eye than above.
vec3 backdrop(vec3 ray) {
  return toLinear(u_backdrop) * mix(1.0, 0.6, smoothstep(-0.3, 0.7, ray.y));
}
