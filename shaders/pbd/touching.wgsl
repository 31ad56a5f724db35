// Sponges in contact with every sponge, one workgroup per sponge: one bit each, behind the ranges of its nodes.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<storage, read> node_touch: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> node_touch_stiffness: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> sponge_ranges: array<vec2<u32>>;

// Bits that are only ever set, so that the order does not matter.
var<workgroup> bits: array<atomic<u32>, SPONGES / 32u>;

fn set_bit(sponge: u32) {
    atomicOr(&bits[sponge / 32u], 1u << (sponge % 32u));
}

@compute @workgroup_size(SPONGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    if (lane < SPONGES / 32u) {
        atomicStore(&bits[lane], 0u);
    }
    workgroupBarrier();
    for (var color = 0u; color < VERTEX_COLORS; color += 1u) {
        let range = sponge_ranges[group.x * RANGES + color];
        for (var row = range.x + lane; row < range.y; row += SPONGE_THREADS) {
            set_bit(u32(node_touch[row][NODE_TOUCH_LOWEST_SPONGE]));
            set_bit(u32(node_touch_stiffness[row][NODE_TOUCH_STIFFNESS_HIGHEST_SPONGE]));
        }
    }
    workgroupBarrier();
    if (lane < SPONGES / 64u) {
        let pair = vec2<u32>(atomicLoad(&bits[2u * lane]), atomicLoad(&bits[2u * lane + 1u]));
        sponge_ranges[group.x * RANGES + VERTEX_COLORS + lane] = pair;
    }
}
