// #include sponges
// The box around every sponge, enlarged by the reach of its nodes, one workgroup per sponge.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> sponge_ranges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> sponge_boxes: array<vec4<f32>>;

var<workgroup> lows: array<vec3<f32>, SPONGE_THREADS>;
var<workgroup> highs: array<vec3<f32>, SPONGE_THREADS>;

@compute @workgroup_size(SPONGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    var low = vec3<f32>(-NO_VALUE);
    var high = vec3<f32>(NO_VALUE);
    for (var color = 0u; color < VERTEX_COLORS; color += 1u) {
        let range = sponge_ranges[group.x * RANGES + color];
        for (var row = range.x + lane; row < range.y; row += SPONGE_THREADS) {
            low = min(low, node_position[row].xyz);
            high = max(high, node_position[row].xyz);
        }
    }
    lows[lane] = low;
    highs[lane] = high;
    for (var half = SPONGE_THREADS / 2u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if (lane < half) {
            lows[lane] = min(lows[lane], lows[lane + half]);
            highs[lane] = max(highs[lane], highs[lane + half]);
        }
    }
    if (lane == 0u) {
        sponge_boxes[group.x * BOX_ROWS] = vec4<f32>(lows[0] - params.pair_radius, 0.0);
        sponge_boxes[group.x * BOX_ROWS + 1u] = vec4<f32>(highs[0] + params.pair_radius, 0.0);
    }
}
