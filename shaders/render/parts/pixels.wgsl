// Pixels from rays: one for every pixel, then more where neighbours differ.

// Ten bits of red, green and blue of every pixel, and what its path met; then the pixels at edges, and how much more rays count there.
@group(0) @binding(7) var<storage, read_write> samples: array<vec2<u32>>;
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

@compute @workgroup_size(8, 8)
fn trace(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= scene.width || id.y >= scene.height) {
        return;
    }
    let seen = seen_at(f32(id.x) + 0.5, f32(id.y) + 0.5);
    samples[id.y * scene.width + id.x] = vec2(packed(displayed(seen.light)), sixteen_bits(seen.met));
}

// More rays for a pixel at an edge.
@compute @workgroup_size(64)
fn refine(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = (group.y * groups.x + group.x) * 64u + lane;
    let pixels = scene.width * scene.height;
    if (row >= edge_count[0]) {
        return;
    }
    let entry = samples[pixels + row];
    let own = samples[entry.x];
    let middle = vec2(f32(entry.x % scene.width), f32(entry.x / scene.width)) + 0.5;
    let colour = unpacked(own.x);
    var sum = colour;
    // Rays start at one place of the text: what is inlined twice takes four times as long to compile.
    let added = 1u + min(scene.more_added, 1u);
    for (var ray = 0u; ray < added; ray++) {
        let offset = select(scene.added.xy, scene.added.zw, ray == 1u);
        sum += displayed(seen_at(middle.x + offset.x, middle.y + offset.y).light);
    }
    samples[entry.x] = vec2(packed(mix(colour, sum / f32(1u + added), bitcast<f32>(entry.y))), own.y);
}
