// #include control_group, corner_list, drag_target
// Targets of the nodes by the drag of the fluid; `couple/drag_target.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_drag: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_node: array<u32>;
@group(0) @binding(7) var<storage, read> control_corners: array<u32>;
@group(0) @binding(8) var<storage, read> node_free: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_target: array<vec4<f32>>;

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
    var sum = vec4<f32>(0.0);
    for (var k = list.x + lane % CONTROL_THREADS; k < list.y; k += CONTROL_THREADS) {
        let place = control_corners[k];
        sum += fluid_shares[place][CORNER_WEIGHT] * fluid_drag[place / TET_CORNERS];
    }
    let received = control_sum(lane, sum);
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let node = control_node[row];
    node_target[node] = drag_target(node_free[node], control_position[row].xyz, control_velocity[row].xyz, received);
}
