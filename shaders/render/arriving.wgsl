// #include numbers, optics, scene
// Light that arrives on the floor: photons, evened out, and the light from everywhere else.

@group(0) @binding(1) var<storage, read> landed: array<u32>;
@group(0) @binding(2) var<storage, read> hollows: array<u32>;
@group(0) @binding(3) var<storage, read_write> ground: array<vec4<f32>>;

fn landed_at(k: u32) -> vec3<f32> {
    return vec3(of_fixed(landed[3u * k]), of_fixed(landed[3u * k + 1u]), of_fixed(landed[3u * k + 2u]));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let side = scene.texels;
    if (id.x >= side || id.y >= side) {
        return;
    }
    let own = id.y * side + id.x;
    var key = vec3(1.0);
    var way = 0.0;
    if (all(id.xy >= vec2(3u)) && all(id.xy + 3u < vec2(side))) {
        // The mean over blocks of 3 by 3, which see all directions over the window; once more, to hide the pattern.
        key = vec3(0.0);
        for (var j = 0u; j < 5u; j++) {
            for (var i = 0u; i < 5u; i++) {
                let weight = f32(min(i + 1u, 5u - i) * min(j + 1u, 5u - j)) / 81.0;
                key += landed_at((id.y + j - 2u) * side + id.x + i - 2u) * weight;
            }
        }
        for (var j = 0u; j < 3u; j++) {
            for (var i = 0u; i < 3u; i++) {
                way += max(ground[side * side + (id.y + j - 1u) * side + id.x + i - 1u].y, 0.0);
            }
        }
        key = min(key, vec3(PHOTONS_BRIGHTEST));
        way /= 9.0;
    }
    let place = scene.ground_corner.xz + (vec2<f32>(id.xy) + 0.5) * scene.texel;
    let under = scene.has_container != 0u && all(place > scene.low.xz) && all(place < scene.high.xz);
    let around = left_after(way * select(0.35, 0.8, under)) / (1.0 + min(of_fixed(hollows[2u * own]), 1.6));
    ground[own] = vec4(
        ROOM_KEY * scene.light.y * key + ROOM_AMBIENT * around,
        min(of_fixed(hollows[2u * own + 1u]), 1.0),
    );
}
