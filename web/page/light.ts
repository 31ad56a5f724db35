// What several shaders share: light, water and room.

/** Absorption of the water (1/m) and the light that it scatters, as in pictures of the library. */
export const WATER = `
// Twice as much as in the library: scenes of a page are half as large.
const vec3 ABSORPTION = vec3(17.0, 4.0, 2.4);
const vec3 SCATTER = vec3(0.03, 0.17, 0.22) * 0.5;
vec3 transmitted(float path) { return exp(-ABSORPTION * path); }
`;

/** A bright room: windows all around, and one in its ceiling. */
export const ROOM = `
float pane(float x, float half_width, float soft) { return 1.0 - smoothstep(half_width - soft, half_width + soft, abs(x)); }
vec3 room(vec3 d) {
  vec3 wall = mix(vec3(0.44, 0.44, 0.43), vec3(0.42, 0.47, 0.52), smoothstep(-0.1, 0.15, d.y));
  wall = mix(wall, vec3(0.70, 0.74, 0.78), smoothstep(0.55, 0.95, d.y));
  float turn = atan(d.z, d.x) * (5.0 / 6.28319);
  float window = pane(fract(turn + 0.3) - 0.5, 0.34, 0.02) * pane(d.y - 0.44, 0.2, 0.02);
  window *= 1.0 - 0.5 * pane(fract(turn + 0.3) - 0.5, 0.012, 0.01);
  vec2 p = d.xz / max(d.y, 0.05);
  float above = pane(p.x + 0.55, 0.35, 0.05) * pane(p.y - 0.3, 0.5, 0.05) * smoothstep(0.5, 0.7, d.y);
  return wall + vec3(0.97, 1.0, 1.04) * (1.3 * window + 1.5 * above);
}
`;

export const LIGHT = `
uniform vec3 eye, sun;
uniform mat4 shadow_view;
uniform sampler2DShadow shadow;
const vec3 SUN = vec3(1.0, 0.96, 0.90) * 1.3;
float lit(vec3 p, vec3 n) {
  vec4 q = shadow_view * vec4(p + 0.0015 * n, 1.0);
  vec3 at = 0.5 * q.xyz + 0.5;
  float angle = fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.067, 0.00584)))) * 6.283;
  float sum = 0.0;
  for (int tap = 0; tap < 12; tap++) {
    float r = sqrt((float(tap) + 0.5) / 12.0) * 0.006;
    float a = angle + 2.4 * float(tap);
    sum += texture(shadow, vec3(at.xy + r * vec2(cos(a), sin(a)), at.z - 0.0012));
  }
  return sum / 12.0;
}
vec3 ambient(vec3 n) { return mix(vec3(0.26, 0.25, 0.24), vec3(0.42, 0.45, 0.49), 0.5 + 0.5 * n.y); }
`;
