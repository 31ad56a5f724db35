// Shaders of the water.

import { ROOM, WATER } from "./light";

/** Where the sun reaches the floor through the water: the share by area, and the path in water. */
export const CAUSTICS_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec3 sun, middle;
uniform float reach, is_bent;
out vec2 straight, landing;
out float path, facing;
void main() {
  float height = position.y - middle.y;
  straight = position.xz - sun.xz * height / sun.y;
  vec3 bent = refract(-sun, dot(normal, sun) > 0.0 ? normal : sun, 0.75);
  landing = position.xz - bent.xz * height / min(bent.y, -0.2);
  path = height / sun.y;
  facing = dot(normal, sun);
  gl_Position = vec4(((is_bent > 0.5 ? landing : straight) - middle.xz) / reach, 0.0, 1.0);
}`;

export const CAUSTICS_FRAGMENT = `
in vec2 straight, landing;
in float path, facing;
uniform float is_bent;
out vec4 result;
void main() {
  if (is_bent < 0.5) {
    result = vec4(0.0, gl_FrontFacing ? -path : path, 0.0, 0.0);
    return;
  }
  if (facing < 0.02) discard;
  vec2 a = dFdx(straight), b = dFdy(straight), c = dFdx(landing), d = dFdy(landing);
  float before = abs(a.x * b.y - a.y * b.x), after = abs(c.x * d.y - c.y * d.x);
  result = vec4(min(before / max(after, 1e-12), 5.0), 0.0, 0.0, 0.0);
}`;

export const WATER_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 view;
out vec3 place, up;
void main() {
  place = position;
  up = normal;
  gl_Position = view * vec4(position, 1.0);
}`;

const DISTANCE = `
uniform sampler2D depth;
uniform vec2 range;
uniform vec3 forward;
// Distance of what is drawn in a pixel along the ray of some direction.
float distance_in(sampler2D depth, vec2 at, vec3 d) {
  float z = 2.0 * texture(depth, at).r - 1.0;
  float along = 2.0 * range.x * range.y / (range.y + range.x - z * (range.y - range.x));
  return along / max(dot(d, forward), 0.05);
}
float distance_at(vec2 at, vec3 d) { return distance_in(depth, at, d); }
`;

/** Of the surface of the water in a pixel. */
const SURFACE = `${DISTANCE}
in vec3 place, up;
uniform vec3 eye;
uniform vec2 size;
out vec4 result;
`;

/** Normal and distance of the first water in a pixel. */
export const WATER_FRAGMENT = `${SURFACE}void main() {
  vec3 way = place - eye;
  float far = length(way);
  if (far > distance_at(gl_FragCoord.xy / size, way / far) + 0.0004) discard;
  result = vec4(up / max(length(up), 1e-6), far);
}`;

/** Length of the ray in water before what is solid, and of all of it, as sums over all surfaces. */
export const THICKNESS_FRAGMENT = `${SURFACE}void main() {
  vec3 way = place - eye;
  float far = length(way);
  float near = min(far, distance_at(gl_FragCoord.xy / size, way / far));
  result = vec4(gl_FrontFacing ? -vec2(near, far) : vec2(near, far), 0.0, 0.0);
}`;

export const SCREEN_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
out vec2 at;
void main() {
  at = 0.5 * position.xy + 0.5;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

export const COMPOSITE_FRAGMENT = `${ROOM}${WATER}${DISTANCE}
in vec2 at;
uniform sampler2D solid, water, thickness, ground, backs;
uniform vec3 eye, sun, right, above;
uniform mat4 view;
uniform float spacing, reach, floor_height;
out vec4 result;
const int STEPS = 48;
vec2 seen_at(vec3 q) {
  vec4 clip = view * vec4(q, 1.0);
  return 0.5 * clip.xy / clip.w + 0.5;
}
// Whether a point is in a body or a sponge: behind its front, and before its back, which is as far as an eye can see of it.
bool is_in_solid(vec3 q) {
  vec3 way = q - eye;
  float far = length(way);
  vec2 there = seen_at(q);
  return far > distance_at(there, way / far) && far < distance_in(backs, there, way / far);
}
// A ray that is bent where it enters the water, and bent back where it leaves it.
struct Ray {
  vec3 start, inside, outside;
  float leaves;
};
vec3 along(Ray ray, float t) {
  return ray.start + ray.inside * min(t, ray.leaves) + ray.outside * max(t - ray.leaves, 0.0);
}
float down_to_floor(vec3 from, vec3 way) { return way.y < -0.01 ? (from.y - floor_height) / -way.y : 1e3; }
// Light that comes along a ray from what it meets, and the length of the ray.
vec4 march(Ray ray, vec2 at) {
  float floor_at = down_to_floor(ray.start, ray.inside);
  if (floor_at > ray.leaves) floor_at = ray.leaves + down_to_floor(along(ray, ray.leaves), ray.outside);
  float step = min(floor_at, ray.leaves + 0.5 * reach) / float(STEPS);
  // Steps begin at another place in every pixel: outlines that they miss would have teeth.
  float shift = fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.067, 0.00584))));
  for (int index = 1; index <= STEPS; index++) {
    float high = step * (float(index) - shift), low = max(high - step, 0.0);
    if (!is_in_solid(along(ray, high))) continue;
    for (int round = 0; round < 5; round++) {
      float t = 0.5 * (low + high);
      if (is_in_solid(along(ray, t))) high = t;
      else low = t;
    }
    return vec4(texture(solid, seen_at(along(ray, high))).rgb, high);
  }
  if (floor_at > 9.0 * reach) return vec4(texture(ground, at).rgb, ray.leaves);
  vec2 there = seen_at(along(ray, floor_at));
  return vec4(texture(ground, clamp(there, 0.0, 1.0)).rgb, floor_at);
}
void main() {
  vec4 first = texture(water, at);
  vec3 behind = texture(solid, at).rgb;
  if (first.w <= 0.0) {
    result = vec4(behind, 1.0);
    return;
  }
  vec3 d = normalize(forward + (2.0 * at.x - 1.0) * right + (2.0 * at.y - 1.0) * above);
  vec3 n = normalize(first.xyz + vec3(0.0, 1e-5, 0.0));
  if (dot(n, d) > 0.0) n = normalize(n - 1.02 * dot(n, d) * d);
  vec3 p = eye + d * first.w;
  vec2 paths = max(texture(thickness, at).rg, vec2(0.0));
  float path = paths.x;
  vec3 bent = refract(d, n, 0.75);
  // A film that is thinner than a particle is no surface.
  float firm = smoothstep(0.05, 0.9, path / spacing);
  vec4 met = march(Ray(p, bent, d, 1.15 * paths.y), at);
  float length_in = min(met.w, max(path, min(1.15 * paths.y, 1.5 * path + 0.3 * reach)));
  // Towards its outlines water is thin: a little colour shows where it ends.
  length_in += 0.1 * reach * firm;
  vec3 straight = behind;
  behind = met.rgb;
  vec3 inside = behind * transmitted(length_in) + SCATTER * (1.0 - exp(-9.0 * length_in));
  float facing = clamp(dot(-d, n), 0.0, 1.0);
  float fresnel = (0.02 + 0.98 * pow(1.0 - facing, 5.0)) * firm;
  vec3 r = reflect(d, n);
  vec3 mirrored = min(room(r), vec3(2.6));
  float spot = pow(clamp(dot(r, sun), 0.0, 1.0), 420.0) * 5.0 * firm;
  vec3 wet = mix(inside, mirrored, fresnel) + spot;
  result = vec4(mix(straight, wet, smoothstep(0.02, 0.3, path / spacing)), 1.0);
}`;
