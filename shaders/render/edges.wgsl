// #include numbers, scene
// Which pixels differ from their neighbours, and how much more rays count there: by degrees, or a pixel at the limit would jump from
// frame to frame.

@group(0) @binding(1) var<storage, read_write> samples: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read_write> edge_count: array<atomic<u32>>;

fn share_of(own: vec2<u32>, x: u32, y: u32) -> f32 {
    let other = samples[min(y, scene.height - 1u) * scene.width + min(x, scene.width - 1u)];
    let limits = select(PIXELS_PATHS, PIXELS_CONTRAST, own.y == other.y);
    let a = vec3<i32>(vec3(own.x, own.x >> 10u, own.x >> 20u) & vec3(PIXELS_MOST));
    let b = vec3<i32>(vec3(other.x, other.x >> 10u, other.x >> 20u) & vec3(PIXELS_MOST));
    let apart = abs(a - b);
    return smooth_between(limits.x, limits.y, f32(max(max(apart.x, apart.y), apart.z)) / f32(PIXELS_MOST));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= scene.width || id.y >= scene.height) {
        return;
    }
    let pixel = id.y * scene.width + id.x;
    if (pixel == 0u) {
        atomicStore(&edge_count[EDGES_LISTED], 1u);
    }
    let own = samples[pixel];
    let sideways = max(share_of(own, max(id.x, 1u) - 1u, id.y), share_of(own, id.x + 1u, id.y));
    let upright = max(share_of(own, id.x, max(id.y, 1u) - 1u), share_of(own, id.x, id.y + 1u));
    let share = max(sideways, upright);
    if (share > 0.0) {
        // The order of the list does not matter: each pixel is refined by itself.
        let place = atomicAdd(&edge_count[0], 1u);
        samples[scene.width * scene.height + place] = vec2(pixel, bitcast<u32>(share));
    }
}
