// Pixels from rays: one for every pixel, then more where neighbours differ.

// Ten bits of red, green and blue of every pixel, and what its path met; then the pixels at edges, and how much more rays count there.
@group(0) @binding(7) var<storage, read_write> samples: array<vec2<u32>>;
// How many pixels are at edges; at `EDGES_LISTED` whether they are listed.
@group(0) @binding(8) var<storage, read> edge_count: array<u32>;

fn direction_of(x: f32, y: f32) -> vec3<f32> {
    let right = (x - 0.5 * f32(scene.width)) * scene.inverse_focal;
    let up = (0.5 * f32(scene.height) - y) * scene.inverse_focal;
    return normalize(scene.forward + scene.right * right + scene.up * up);
}

fn sixteen_bits(met: u32) -> u32 {
    return (met ^ (met >> 16u)) & 0xffffu;
}

fn packed(colour: vec3<f32>) -> u32 {
    let c = vec3<u32>(colour * f32(PIXELS_MOST) + 0.5);
    return c.x | (c.y << 10u) | (c.z << 20u);
}

fn unpacked(word: u32) -> vec3<f32> {
    return vec3<f32>(vec3(word, word >> 10u, word >> 20u) & vec3(PIXELS_MOST)) / f32(PIXELS_MOST);
}

// A group of 8 x 8 pixels with a ray for each or, once the pixels at edges are listed, 64 of those with more rays. It is one entry with one
// ray in the text: what a ray needs takes long to compile.
@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = group.y * groups.x + group.x;
    let refines = edge_count[EDGES_LISTED] != 0u;
    let tiles = (scene.width + 7u) / 8u;
    let place = 8u * vec2(index % tiles, index / tiles) + vec2(lane % 8u, lane / 8u);
    var pixel = place.y * scene.width + place.x;
    var share = 1.0;
    var own = vec2(0u);
    var sum = vec3(0.0);
    var rays = 1u;
    if (refines) {
        let row = GROUP * index + lane;
        if (row >= edge_count[0]) {
            return;
        }
        let entry = samples[scene.width * scene.height + row];
        pixel = entry.x;
        share = bitcast<f32>(entry.y);
        own = samples[pixel];
        sum = unpacked(own.x);
        rays = 1u + min(scene.more_added, 1u);
    } else if (place.x >= scene.width || place.y >= scene.height) {
        return;
    }
    let middle = vec2(f32(pixel % scene.width), f32(pixel / scene.width)) + 0.5;
    var seen = Shine(vec3(0.0), 0u);
    for (var ray = 0u; ray < rays; ray++) {
        let added = select(scene.added.xy, scene.added.zw, ray == 1u);
        let offset = select(vec2(0.0), added, refines);
        seen = seen_at(middle.x + offset.x, middle.y + offset.y);
        sum += displayed(seen.light);
    }
    if (refines) {
        let mean = mix(unpacked(own.x), sum / f32(1u + rays), share);
        samples[pixel] = vec2(packed(mean), own.y);
    } else {
        samples[pixel] = vec2(packed(sum), sixteen_bits(seen.met));
    }
}
