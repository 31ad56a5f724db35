// #include sponges, control_group, corner_list
// Reaction of the suction of particles on the corners of their tets; `suction.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> fluid_corner_forces: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_node: array<u32>;
@group(0) @binding(5) var<storage, read> control_corners: array<u32>;
@group(0) @binding(6) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(8) var<storage, read_write> node_acceleration: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let list = corner_list(row, is_row);
    var part = vec3<f32>(0.0);
    for (var k = list.x + lane % CONTROL_THREADS; k < list.y; k += CONTROL_THREADS) {
        part += fluid_corner_forces[control_corners[k]].xyz;
    }
    let force = control_sum(lane, vec4<f32>(part, 0.0)).xyz;
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let node = control_node[row];
    let scale = sponges.all[node_sponge[node]].reaction * node_position[node].w;
    let before = node_acceleration[node];
    node_acceleration[node] = vec4<f32>(before.xyz + force * scale, before.w);
}
