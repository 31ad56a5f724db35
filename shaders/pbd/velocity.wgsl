// #include sponges
// Velocity from the corrected positions: v = (y - x) / h, x <- y; the largest speed, and the first row that is not finite.
// Sleeping sponges are left alone.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(4) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> node_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> node_velocity: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> extremes: array<atomic<u32>>;

var<workgroup> largest: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    if (lane == 0u) {
        atomicStore(&largest, 0u);
    }
    workgroupBarrier();
    var moves = false;
    if (row < params.node_rows) {
        moves = !is_asleep(sponges.all[node_sponge[row]]);
    }
    if (moves) {
        let y = node_predicted[row];
        let v = (y.xyz - node_position[row].xyz) * clock.inverse_step;
        node_velocity[row] = with_vector(node_velocity[row], v);
        node_position[row] = y;
        let square = dot(v, v);
        if (is_finite(square)) {
            atomicMax(&largest, bitcast<u32>(square));
        } else {
            atomicMax(&extremes[EXTREME_NODE_ROW], 0xffffffffu - row);
        }
    }
    workgroupBarrier();
    if (lane == 0u) {
        atomicMax(&extremes[EXTREME_NODE_SPEED], atomicLoad(&largest));
    }
}
