// Shaders. Light is linear until the last pass.

import { LIGHT, ROOM, WATER } from "./light";

export const SOLID_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 view, model;
out vec3 place, up;
void main() {
  vec4 p = model * vec4(position, 1.0);
  place = p.xyz;
  // Scaled alike or along the faces: the inverse scale is that of the normal of a box.
  up = mat3(model) * (normal / vec3(dot(model[0], model[0]), dot(model[1], model[1]), dot(model[2], model[2])));
  gl_Position = view * p;
}`;

export const SHADOW_FRAGMENT = `void main() {}`;

export const BODY_FRAGMENT = `${ROOM}${LIGHT}
in vec3 place, up;
uniform vec3 colour;
out vec4 result;
void main() {
  vec3 n = normalize(up), d = normalize(place - eye);
  float facing = max(dot(n, sun), 0.0);
  vec3 diffuse = colour * (ambient(n) + SUN * facing * lit(place, n));
  float fresnel = 0.04 + 0.5 * pow(1.0 - clamp(dot(n, -d), 0.0, 1.0), 5.0);
  vec3 mirrored = min(room(reflect(d, n)), vec3(1.6));
  float spot = pow(max(dot(reflect(d, n), sun), 0.0), 180.0) * 2.0;
  result = vec4(mix(diffuse, mirrored, fresnel) + spot * facing, 1.0);
}`;

/** Shells of glass: what mirrors and the rim, over what is behind. */
export const GLASS_FRAGMENT = `${ROOM}
uniform vec3 eye, sun;
uniform vec3 colour;
uniform float least;
in vec3 place, up;
out vec4 result;
void main() {
  vec3 n = normalize(up), d = normalize(place - eye);
  float facing = abs(dot(n, d));
  vec3 r = reflect(d, dot(n, d) < 0.0 ? n : -n);
  float fresnel = 0.05 + 0.75 * pow(1.0 - min(facing, 1.0), 4.0);
  float spot = pow(max(dot(r, sun), 0.0), 250.0) * 3.0;
  float cover = clamp(fresnel + least, 0.0, 0.9);
  vec3 light = mix(colour, min(room(r), vec3(1.8)), fresnel / cover) + spot;
  result = vec4(light * cover, cover);
}`;

export const SKIN_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 rest;
layout(location = 3) in float saturation;
uniform mat4 view;
out vec3 place, up, home;
out float wetness;
void main() {
  place = position;
  up = normal;
  home = rest;
  wetness = smoothstep(0.02, 0.85, saturation);
  gl_Position = view * vec4(position, 1.0);
}`;

export const SKIN_FRAGMENT = `${ROOM}${LIGHT}
in vec3 place, up, home;
in float wetness;
uniform sampler3D pores;
out vec4 result;
const float PERIOD = 0.034;
float pore(vec3 at) { return texture(pores, at / PERIOD).r; }
void main() {
  vec3 n = normalize(up), d = normalize(place - eye);
  // The direction of the ray in the sponge at rest, from what a pixel is there and here.
  vec3 a = dFdx(place), b = dFdy(place), ra = dFdx(home), rb = dFdy(home);
  vec3 face = cross(a, b), rest_face = cross(ra, rb);
  float area = dot(face, face);
  vec3 inward = d;
  if (area > 1e-24 && dot(rest_face, rest_face) > 1e-24) {
    float u = dot(cross(d, b), face) / area, v = dot(cross(a, d), face) / area;
    inward = u * ra + v * rb + dot(d, normalize(face)) * normalize(rest_face);
    inward *= min(1.0, 1.5 / length(inward));
  }
  float depth = 0.0, own = pore(home);
  vec3 at = home;
  for (int step = 0; step < 9; step++) {
    if (pore(at) > 0.5) break;
    depth += 0.00045;
    at = home + inward * depth;
  }
  float height = smoothstep(0.3, 0.75, own) * 0.0011;
  vec3 r1 = cross(b, n), r2 = cross(n, a);
  float det = dot(a, r1);
  vec3 slope = sign(det) * (dFdx(height) * r1 + dFdy(height) * r2) / max(abs(det), 1e-12);
  // At outlines a pixel spans more than a pore.
  n = normalize(n - slope * min(1.0, 1.2 / max(length(slope), 1e-6)) * 0.8);
  float fine = pore(home * 3.7 + 0.013);
  vec3 albedo = mix(vec3(0.88, 0.63, 0.20), vec3(0.50, 0.28, 0.06), wetness);
  albedo *= 0.86 + 0.2 * fine;
  float open = exp(-depth / 0.0016);
  albedo = mix(albedo * albedo * 0.55, albedo, open);
  float facing = max(dot(n, sun), 0.0);
  float wrap = max((dot(n, sun) + 0.25) / 1.25, 0.0);
  vec3 light = albedo * (ambient(n) * (0.35 + 0.65 * open) + SUN * mix(wrap, facing, 0.5) * lit(place, n) * (0.25 + 0.75 * open));
  vec3 half_way = normalize(sun - d);
  float gloss = pow(max(dot(n, half_way), 0.0), 40.0) * 0.35 + 0.10 * pow(1.0 - clamp(dot(n, -d), 0.0, 1.0), 4.0);
  result = vec4(light + wetness * open * gloss, 1.0);
}`;

export const FLOOR_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 view;
uniform vec3 middle;
out vec3 place;
void main() {
  place = middle + vec3(position.x, 0.0, position.y) * 6.0;
  gl_Position = view * vec4(place, 1.0);
}`;

export const FLOOR_FRAGMENT = `${ROOM}${LIGHT}${WATER}
in vec3 place;
uniform vec3 middle;
uniform float pitch, reach;
uniform vec2 half_size;
uniform sampler2D caustics;
out vec4 result;
float line(vec2 p, vec2 blur) {
  vec2 d = abs(fract(p - 0.5) - 0.5);
  vec2 w = 1.0 - smoothstep(0.018 - blur * 0.5, 0.018 + blur, d);
  return max(w.x, w.y);
}
void main() {
  vec2 p = place.xz / pitch;
  vec2 blur = max(fwidth(p), vec2(0.004));
  float firm = 1.0 - smoothstep(0.15, 0.6, max(blur.x, blur.y));
  vec2 cell = abs(fract(0.5 * p) - 0.5) - 0.25;
  vec2 soft = clamp(cell / max(blur, 1e-4) * 2.0, -1.0, 1.0);
  float check = 0.5 + 0.5 * soft.x * soft.y;
  vec3 tile = mix(vec3(0.62), mix(vec3(0.69, 0.68, 0.66), vec3(0.555, 0.56, 0.57), check), firm);
  tile = mix(tile, vec3(0.45, 0.45, 0.45), line(p, blur) * 0.5 * firm);
  vec2 at = (place.xz - middle.xz) / (2.0 * reach) + 0.5;
  vec3 light = vec3(1.0);
  if (all(lessThan(abs(at - 0.5), vec2(0.5)))) {
    vec2 texel = 1.0 / vec2(textureSize(caustics, 0));
    vec4 seen = texture(caustics, at) * 0.4;
    for (int tap = 0; tap < 4; tap++) {
      vec2 way = vec2(float(tap & 1) * 2.0 - 1.0, float(tap >> 1) * 2.0 - 1.0);
      seen += texture(caustics, at + 1.3 * way * texel) * 0.15;
    }
    float path = max(seen.g, 0.0);
    // Beside the water its shadow has the light that its sides give.
    vec2 beyond = abs(place.xz - middle.xz) - half_size;
    float least = max(beyond.x, beyond.y) > 0.0 ? 0.72 : 0.4;
    light = mix(vec3(1.0), vec3(clamp(seen.r, least, 3.0)), smoothstep(0.0005, 0.006, path)) * transmitted(path);
  }
  vec3 n = vec3(0.0, 1.0, 0.0);
  float far = length(place.xz - middle.xz);
  float shade = far < 4.0 * reach ? lit(place, n) : 1.0;
  vec3 colour = tile * (ambient(n) + SUN * sun.y * shade * light);
  result = vec4(mix(colour, vec3(0.80, 0.83, 0.86) * 1.05, smoothstep(0.7, 4.5, far / (8.0 * reach) * 2.0)), 1.0);
}`;

export const DISPLAY_FRAGMENT = `
in vec2 at;
uniform sampler2D light;
out vec4 result;
void main() {
  // Highlights are compressed as by a film (the fit of ACES by Narkowicz), then encoded as sRGB.
  vec3 x = 0.68 * texture(light, at).rgb;
  vec3 y = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  y = mix(12.92 * y, 1.055 * pow(y, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, y));
  result = vec4(y, dot(y, vec3(0.299, 0.587, 0.114)));
}`;

/** Edges without steps: colours are mixed along them (FXAA). */
export const EDGES_FRAGMENT = `
in vec2 at;
uniform sampler2D picture;
out vec4 result;
void main() {
  vec2 texel = 1.0 / vec2(textureSize(picture, 0));
  vec4 own = texture(picture, at);
  float nw = texture(picture, at + texel * vec2(-1, 1)).a, ne = texture(picture, at + texel).a;
  float sw = texture(picture, at - texel).a, se = texture(picture, at + texel * vec2(1, -1)).a;
  float low = min(own.a, min(min(nw, ne), min(sw, se))), high = max(own.a, max(max(nw, ne), max(sw, se)));
  vec2 way = vec2(sw + se - nw - ne, nw + sw - ne - se) * vec2(1.0, 1.0);
  way.y = nw + sw - ne - se;
  way.x = -(nw + ne - sw - se);
  float least = max((nw + ne + sw + se) * 0.03125, 0.0078);
  way = clamp(way / (min(abs(way.x), abs(way.y)) + least), -8.0, 8.0) * texel;
  vec3 near = 0.5 * (texture(picture, at - way / 6.0).rgb + texture(picture, at + way / 6.0).rgb);
  vec4 far = 0.5 * (texture(picture, at - 0.5 * way) + texture(picture, at + 0.5 * way));
  vec3 wide = 0.5 * near + 0.5 * far.rgb;
  float luma = dot(wide, vec3(0.299, 0.587, 0.114));
  result = vec4(high - low < 0.04 ? own.rgb : (luma < low || luma > high ? near : wide), 1.0);
}`;

/** Particles as balls: a ball on the square that faces the eye. */
export const BALL_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 particle;
uniform mat4 view;
uniform vec3 right_unit, above_unit, forward;
uniform float radius;
out vec3 place, up;
out float held;
void main() {
  vec3 p = radius * (position.x * right_unit + position.y * above_unit);
  up = p;
  place = particle.xyz + p;
  held = particle.w;
  gl_Position = view * vec4(place, 1.0);
}`;

export const BALL_FRAGMENT = `${LIGHT}
in vec3 place, up;
in float held;
uniform vec3 forward;
uniform float radius;
out vec4 result;
void main() {
  float rest = 1.0 - dot(up, up) / (radius * radius);
  if (rest < 0.0) discard;
  vec3 n = normalize(up / radius - forward * sqrt(rest));
  vec3 colour = mix(vec3(0.10, 0.36, 0.62), vec3(0.62, 0.36, 0.10), clamp(held, 0.0, 1.0));
  result = vec4(colour * (ambient(n) + SUN * max(dot(n, sun), 0.0) * lit(place, n)), 1.0);
}`;
