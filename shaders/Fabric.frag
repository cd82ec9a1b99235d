#version 330

// Woven cloth in the house look: thread highlights along warp and weft, a sheen at grazing angles,
// light that shines through, a colour for each side, soft shadows.

#include "house_light.glsl"

uniform vec4 u_color;
uniform vec4 u_back_color;

uniform vec3 u_front;     // @color @default 1 1 1 @label Front @help Tint of the front, times the cloth's colour
uniform vec3 u_back;      // @color @default 0.93 0.89 0.82 @label Back @help Tint of the back, times the colour of its back
uniform float u_threads;  // @range 0 400 @default 220 @label Threads @help Threads across the cloth each way; 0: smooth
uniform float u_gloss;    // @range 0 1 @default 0.35 @label Gloss @help Strength of the highlight of the threads
uniform float u_sheen;    // @range 0 1 @default 0.35 @label Sheen @help Light caught by fibres that stand off
uniform float u_through;  // @range 0 1 @default 0.25 @label Translucency @help Share of the light that shines through

in vec4 v_position;
in vec4 v_normal;
in vec2 v_uv;
out vec4 out_color;

// The highlight of fibres along t: Kajiya and Kay 1989, "Rendering fur with three dimensional
// textures", equation 15, with an exponent that makes it as wide as a spun yarn's.
float threadHighlight(vec3 t, vec3 h) {
  float along = dot(t, h);
  return pow(max(0.0, 1.0 - along * along), 24.0);
}

// The sheen of standing fibres: distribution of Estevez and Kulla 2017, "Production friendly
// microfacet sheen BRDF", visibility of Neubelt and Pettineo 2013.
float sheenHighlight(vec3 n, vec3 l, vec3 v) {
  const float kRoughness = 0.45;
  vec3 h = normalize(l + v);
  float cosine = clamp(dot(n, h), 0.0, 1.0), nl = clamp(dot(n, l), 0.0, 1.0), nv = clamp(dot(n, v), 0.0, 1.0);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  float d = (2.0 + 1.0 / kRoughness) * pow(sine, 1.0 / kRoughness) / (2.0 * kPi);
  return d * nl / (4.0 * (nl + nv - nl * nv) + 1e-3);
}

// Plain weave: warp and weft take turns on top. x: how much the warp is on top, 0..1. y: height of
// the thread on top, 0..1. Both tend to their mean where a pixel spans a thread or more, so that the
// pattern fades instead of shimmering.
vec2 weave(vec2 uv) {
  vec2 thread = u_threads * uv;
  vec2 span = fwidth(thread);
  float sharp = u_threads < 1.0 ? 0.0 : clamp(1.5 - 2.5 * max(span.x, span.y), 0.0, 1.0);
  vec2 cell = floor(thread), inside = fract(thread);
  float warpOnTop = mod(cell.x + cell.y, 2.0);
  float across = warpOnTop > 0.5 ? inside.x : inside.y, along = warpOnTop > 0.5 ? inside.y : inside.x;
  float height = sin(kPi * across) * (0.55 + 0.45 * sin(kPi * along));
  return mix(vec2(0.5, 0.53), vec2(warpOnTop, height), sharp);
}

void main() {
  vec3 v = normalize(u_cam_pos - v_position.xyz);
  vec3 n = normalize(v_normal.xyz);
  if (!gl_FrontFacing) n = -n;
  // Where a coarse triangle's normals point away from the eye although its front is seen.
  n = normalize(n + max(0.0, 0.02 - dot(n, v)) * v);

  // Warp and weft: the directions in which v and u grow.
  vec3 px = dFdx(v_position.xyz), py = dFdy(v_position.xyz);
  vec2 ux = dFdx(v_uv), uy = dFdy(v_uv);
  vec3 u = px * uy.y - py * ux.y;
  u -= dot(u, n) * n;
  vec3 weft = normalize(dot(u, u) > 0.0 ? u : vec3(1e-3, 0, 0) + cross(n, vec3(0, 0, 1)));
  vec3 warp = cross(n, weft);

  vec2 woven = weave(v_uv);
  vec3 base = toLinear(gl_FrontFacing ? u_front * u_color.rgb : u_back * u_back_color.rgb);
  base *= 0.86 * mix(0.8, 1.13, woven.y);  // No cloth is whiter than 0.86.

  vec3 toLight = u_light_pos - v_position.xyz;
  vec3 l = normalize(toLight), h = normalize(l + v);
  float cosine = dot(n, l);
  Light light = lightAt(v_position.xyz, n, cosine < 0.0 ? -n : n);

  // A little of the light goes round the edge of the terminator, as in any porous surface.
  float wrapped = max(0.0, (cosine + 0.1) / 1.1);
  float through = u_through * max(0.0, -cosine);
  vec3 color = base * light.lamp * (wrapped + through);
  float lit = smoothstep(-0.05, 0.25, cosine);
  float highlight = mix(threadHighlight(weft, h), threadHighlight(warp, h), woven.x);
  vec3 fibre = mix(vec3(1.0), base, 0.5);  // What a fibre scatters at its surface, before dye.
  color += light.lamp * lit * fibre * (0.22 * u_gloss * highlight * woven.y + 0.5 * u_sheen * sheenHighlight(n, l, v));
  // At grazing angles fibres hide the weave, from the light all around as well.
  float grazing = pow(1.0 - clamp(dot(n, v), 0.0, 1.0), 4.0);
  color += mix(base, fibre, 0.7 * u_sheen * grazing) * light.open * light.fill;

  out_color = vec4(toDisplay(color), 1.0);
}
