// Values, normals and crossings of the density of the water, less the level of its surface: positive inside.

@group(0) @binding(1) var<storage, read> densities: array<f32>;
// Content of every brick, and from its second byte on how many bricks to each side are as it is.
@group(0) @binding(2) var<storage, read> bricks: array<u32>;

// The first of the eight nodes around a place in cells.
fn first_node(place: vec3<f32>) -> vec3<f32> {
    return clamp(place, vec3(1.0), scene.field_last);
}

fn node_index(node: vec3<u32>) -> u32 {
    return (node.z * scene.field_sides.y + node.y) * scene.field_sides.x + node.x;
}

// The value at a place in cells, linear between nodes.
fn value_in(place: vec3<f32>) -> f32 {
    let inside = first_node(place);
    let node = vec3<u32>(inside);
    let f = inside - vec3<f32>(node);
    let at = node_index(node);
    let up = at + scene.field_sides.x;
    let layer = scene.field_sides.x * scene.field_sides.y;
    let near = mix(mix(densities[at], densities[at + 1u], f.x), mix(densities[up], densities[up + 1u], f.x), f.y);
    let far = mix(
        mix(densities[at + layer], densities[at + layer + 1u], f.x),
        mix(densities[up + layer], densities[up + layer + 1u], f.x),
        f.y,
    );
    return mix(near, far, f.z);
}

fn field_value(point: vec3<f32>) -> f32 {
    return value_in((point - scene.field_origin) * scene.field_inverse);
}

// Outward normal: central differences at the corners of the cell, linear between them, so that it is continuous.
fn field_normal(point: vec3<f32>) -> vec3<f32> {
    let inside = first_node((point - scene.field_origin) * scene.field_inverse);
    let node = vec3<u32>(inside);
    let f = inside - vec3<f32>(node);
    let at = node_index(node);
    let row = scene.field_sides.x;
    let layer = row * scene.field_sides.y;
    let end = layer * scene.field_sides.z;
    var sum = vec3(0.0);
    for (var corner = 0u; corner < 8u; corner++) {
        let bits = vec3(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        let index = at + bits.x + bits.y * row + bits.z * layer;
        let weights = select(1.0 - f, f, bits != vec3(0u));
        let low = max(index, layer);
        let high = min(index, end - layer - 1u);
        sum += vec3(
            densities[high + 1u] - densities[low - 1u],
            densities[high + row] - densities[low - row],
            densities[high + layer] - densities[low - layer],
        ) * (weights.x * weights.y * weights.z);
    }
    return -unit_or(sum * scene.field_inverse, vec3(0.0, -1.0, 0.0));
}

// The first change of sign between two distances, in steps that follow the value; the value at the end if there is none.
struct Crossing {
    found: bool,
    distance: f32,
    value: f32,
}

fn cross_brick(start: vec3<f32>, slope: vec3<f32>, begin: vec3<f32>, known: bool, side: f32) -> Crossing {
    let end = begin.y;
    let pace = FIELD_SAFE * scene.spacing;
    let shortest = 0.9 * scene.cell;
    var before = begin.x;
    var t = begin.x;
    // Rays start within rounding of the surface.
    var here = select(0.0, begin.z, known);
    if (known) {
        t = min(t + max(here * pace, shortest), end);
    }
    loop {
        let there = value_in(start + slope * t) * side;
        if (t > begin.x && there < 0.0) {
            return Crossing(true, narrowed(start, slope, vec4(before, here, t, there), side), 0.0);
        }
        before = t;
        here = max(there, 1.0e-6);
        if (!(t < end)) {
            return Crossing(false, end, here);
        }
        t = min(t + max(here * pace, shortest), end);
    }
    return Crossing(false, end, here);
}

// The zero between a place with a value above it and one with a value below it: regula falsi.
fn narrowed(start: vec3<f32>, slope: vec3<f32>, bounds: vec4<f32>, side: f32) -> f32 {
    var a = bounds.xy;
    var b = bounds.zw;
    for (var round = 0u; round < FIELD_ROUNDS; round++) {
        let middle = a.x + (b.x - a.x) * clamp(a.y / (a.y - b.y), 0.05, 0.95);
        let v = value_in(start + slope * middle) * side;
        if (v < 0.0) {
            b = vec2(middle, v);
        } else {
            a = vec2(middle, v);
        }
    }
    return a.x + (b.x - a.x) * (a.y / (a.y - b.y));
}

// Where a ray first leaves the water (`inside`) or enters it, between two distances; `FAR_AWAY` where it does not.
fn march(origin: vec3<f32>, direction: vec3<f32>, range: vec2<f32>, inside: bool) -> f32 {
    let start = (origin - scene.field_origin) * scene.field_inverse;
    let slope = direction * scene.field_inverse;
    let scale = 1.0 / f32(BRICKS_BRICK);
    let begin = start * scale;
    let pace = slope * scale;
    let inverse = inverse_of(pace);
    let sides = (vec3<f32>(scene.field_sides) - 1.0) * scale;
    let a = -begin * inverse;
    let b = (sides - begin) * inverse;
    var t = max(range.x, most(min(a, b)));
    let end = min(range.y, least(max(a, b)));
    let own = select(BRICK_AIR, BRICK_WATER, inside);
    let side = select(-1.0, 1.0, inside);
    let nudge = 0.0135 * scene.cell;
    // The value where the last brick was left.
    var known = false;
    var here = 0.0;
    while (t < end) {
        let brick = min(vec3<u32>(max(begin + pace * t, vec3(0.0))), scene.brick_sides - 1u);
        let word = bricks[(brick.z * scene.brick_sides.y + brick.y) * scene.brick_sides.x + brick.x];
        let content = word & 0xffu;
        let skip = f32(word >> 8u);
        let low = vec3<f32>(brick);
        let far = select(low + 1.0 - skip, low + skip, inverse > vec3(0.0));
        let exit = max(least((far - begin) * inverse), t) + nudge;
        if (content == own) {
            t = exit;
            known = false;
            continue;
        }
        if (content != BRICK_SURFACE) {
            return t;
        }
        let stop = min(exit, end);
        let crossing = cross_brick(start, slope, vec3(t, stop, here), known, side);
        if (crossing.found) {
            return crossing.distance;
        }
        t = stop;
        known = true;
        here = crossing.value;
    }
    return FAR_AWAY;
}
