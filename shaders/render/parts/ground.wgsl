// Light that arrives on the floor, and the heights of what it meets before, on square maps.

// The light on every texel of the floor with its wetness. Then, for every texel, the ways along the light to the first solid and to the
// first water (m).
@group(0) @binding(5) var<storage, read> ground: array<vec4<f32>>;

fn arriving_row(k: u32, f: f32) -> vec4<f32> {
    return ground[k] * (1.0 - f) + ground[k + 1u] * f;
}

// Light on the floor at a point, and how wet it is.
fn arriving_at(point: vec3<f32>) -> vec4<f32> {
    let at = (point.xz - scene.ground_corner.xz) / scene.texel - 0.5;
    let last = f32(scene.texels) - 1.0;
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < last && at.y < last)) {
        return vec4(ROOM_KEY * scene.light.y + ROOM_AMBIENT, 0.0);
    }
    let cell = vec2<u32>(at);
    let f = at - vec2<f32>(cell);
    let k = cell.y * scene.texels + cell.x;
    return arriving_row(k, f.x) * (1.0 - f.y) + arriving_row(k + scene.texels, f.x) * f.y;
}

fn tap(k: u32, f: f32) -> f32 {
    return select(select(1.0, f, k == 3u), 1.0 - f, k == 0u);
}

// Share of the key light that solids let through to a point, and the length of its way in the water (m).
fn shadow_at(point: vec3<f32>) -> vec2<f32> {
    let rise = (point.y - scene.ground_corner.y) / scene.light.y;
    let at = (point - scene.light * rise - scene.ground_corner).xz / scene.texel - 1.5;
    let last = f32(scene.texels) - 5.0;
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x <= last && at.y <= last)) {
        return vec2(1.0, 0.0);
    }
    let cell = vec2<u32>(at);
    let f = at - vec2<f32>(cell);
    let edge = rise + 2.6 * scene.texel;
    let first = scene.texels * scene.texels;
    var sums = vec2(0.0);
    for (var j = 0u; j < 4u; j++) {
        let row = first + (cell.y + j) * scene.texels + cell.x;
        for (var i = 0u; i < 4u; i++) {
            let weight = tap(i, f.x) * tap(j, f.y);
            let ways = ground[row + i].xy;
            sums += weight * vec2(select(0.0, 1.0, ways.x < edge), max(ways.y - rise, 0.0));
        }
    }
    return sums / 9.0;
}
