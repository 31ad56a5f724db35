// What a ray sees of a sponge below its outer surface: pores, their shade, wetness.

// A triangle of the sponge: rows of its nodes, and their weights.
struct Facet {
    nodes: vec3<u32>,
    weights: vec3<f32>,
}

// The place of a sponge that a ray sees.
struct Skin {
    normal: vec3<f32>,
    // Normal of the outer surface, without pores.
    outer: vec3<f32>,
    albedo: vec3<f32>,
    // Share of the light that reaches the place in its pore, 0 to 1.
    open: f32,
    wet: f32,
}

fn facet_of(slot: u32, place: vec2<f32>) -> Facet {
    let at = scene.triangles_at + 3u * slot;
    let nodes = vec3(bitcast<u32>(mesh[at].w), bitcast<u32>(mesh[at + 1u].w), bitcast<u32>(mesh[at + 2u].w));
    return Facet(scene.nodes_at + 3u * nodes, vec3(1.0 - place.x - place.y, place.x, place.y));
}

// A row of the nodes, mixed: 0 place and wetness, 1 normal and film, 2 place at rest.
fn facet_mix(facet: Facet, row: u32) -> vec4<f32> {
    return mesh[facet.nodes.x + row] * facet.weights.x + mesh[facet.nodes.y + row] * facet.weights.y
        + mesh[facet.nodes.z + row] * facet.weights.z;
}

fn facet_wetness(facet: Facet) -> f32 {
    return facet_mix(facet, 0u).w;
}

fn facet_film(facet: Facet) -> f32 {
    return facet_mix(facet, 1u).w;
}

fn facet_normal(facet: Facet) -> vec3<f32> {
    return unit_or(facet_mix(facet, 1u).xyz, vec3(0.0));
}

fn frame_of(facet: Facet, row: u32) -> mat3x3<f32> {
    let a = mesh[facet.nodes.x + row].xyz;
    let e = mesh[facet.nodes.y + row].xyz - a;
    let f = mesh[facet.nodes.z + row].xyz - a;
    return mat3x3<f32>(e, f, unit_or(cross(e, f), vec3(0.0)));
}

fn inverse_matrix(m: mat3x3<f32>, determinant: f32) -> mat3x3<f32> {
    let x = cross(m[1], m[2]);
    let y = cross(m[2], m[0]);
    let z = cross(m[0], m[1]);
    return transpose(mat3x3<f32>(x, y, z)) * (1.0 / determinant);
}

// From directions in the world to those of the sponge at rest.
fn to_rest(facet: Facet) -> mat3x3<f32> {
    let now = frame_of(facet, 0u);
    let determinant = dot(cross(now[0], now[1]), now[2]);
    if (abs(determinant) < 1.0e-20) {
        return mat3x3<f32>(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
    }
    return frame_of(facet, 2u) * inverse_matrix(now, determinant);
}

// Length of the way to the wall of a pore (m), and the distance from it there (mm).
fn descend(place: vec3<f32>, direction: vec3<f32>, start: f32) -> vec2<f32> {
    var way = 0.0;
    var value = start;
    var before = vec2(0.0, start);
    while (value < 0.0 && way < SKIN_DEPTH) {
        before = vec2(way, value);
        way += max(-value * 0.8e-3, 0.25e-3);
        value = foam_distance(place + direction * way);
    }
    if (value > 0.0 && before.y < 0.0) {
        way = before.x + (way - before.x) * before.y / (before.y - value);
        value = 0.0;
    }
    return vec2(way, value);
}

// Whether a ray that meets the outer surface in a pore leaves the sponge again, after a distance (m), before it meets a wall: pores
// cut the outline.
fn is_notched(facet: Facet, direction: vec3<f32>, exit: f32) -> bool {
    let place = facet_mix(facet, 2u).xyz;
    let start = foam_distance(place);
    if (start >= 0.0) {
        return false;
    }
    let inward = to_rest(facet) * direction;
    return descend(place, unit_or(inward, vec3(0.0)), start).x >= exit * length(inward);
}

// The skin of a sponge where a ray meets it.
//
// `pixel` is the side of a pixel there (m): finer detail is left out. `film` is the wetness of water on it.
fn skin_of(facet: Facet, direction: vec3<f32>, pixel: f32, film: f32) -> Skin {
    let wet = max(facet_wetness(facet), film);
    let normal = facet_normal(facet);
    let place = facet_mix(facet, 2u).xyz;
    let start = foam_distance(place);
    let detail = 1.0 - smooth_between(0.4e-3, 1.6e-3, pixel);
    var depth = 0.0;
    var bent = normal;
    // Away from pores there is nothing to march through and nothing to bend.
    if (start < 0.5) {
        let rest = to_rest(facet);
        let inward = unit_or(rest * direction, vec3(0.0));
        let found = descend(place, inward, start);
        // A rim is at least as wide as a pixel, or it would jump from sample to sample.
        let edge = smooth_between(0.0, max(1.0e3 * pixel, 0.05), -start);
        depth = min(found.x * max(-dot(direction, normal), 0.15), SKIN_DEPTH) * edge;
        let end = place + inward * found.x;
        var slope = vec3(0.0);
        var here = 0.0;
        for (var axis = 0u; axis < 4u; axis++) {
            var offset = vec3(0.0);
            if (axis > 0u) {
                offset[axis - 1u] = SKIN_STENCIL;
            }
            let distance = foam_distance(end + offset);
            if (axis == 0u) {
                here = distance;
            } else {
                slope[axis - 1u] = distance - here;
            }
        }
        let wall = (slope * (-1.0 / (SKIN_STENCIL * 1.0e3))) * rest;
        // The wall of a pore faces into it, near to it only.
        let rim = 1.0 - smooth_between(0.0, 0.5, found.y);
        bent = unit_or(normal + (wall - normal * dot(wall, normal)) * (0.72 * rim * detail), normal);
    }
    let fine = 0.92 + 0.16 * detail * clamp(foam_distance(place * 4.3), -0.5, 0.5);
    let base = mix(SKIN_DRY, SKIN_SOAKED, smooth_between(0.03, 0.75, wet)) * fine;
    // Light from the bottom of a pore has the colour of its walls.
    let open = exp(-depth / 1.5e-3);
    let albedo = base * vec3(1.0, 0.72 + 0.28 * open, 0.5 + 0.5 * open);
    return Skin(bent, normal, albedo, open, wet);
}
