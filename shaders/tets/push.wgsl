// #include control_group, corner_list
// Second pass of `tets::response`: force of the pressure on every node, and the impulse of the water that drag holds.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_carried: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_corners: array<u32>;
@group(0) @binding(5) var<storage, read_write> control_force: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> control_solved: array<vec4<f32>>;

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
    var push = vec3<f32>(0.0);
    var drawn = vec3<f32>(0.0);
    for (var k = list.x + lane % CONTROL_THREADS; k < list.y; k += CONTROL_THREADS) {
        let place = control_corners[k];
        let own = fluid_shares[place];
        let carried = fluid_carried[place / TET_CORNERS];
        push += own.xyz * carried[FLUID_CARRIED_ENERGY];
        drawn += carried.xyz * own[CORNER_WEIGHT];
    }
    let pushed = control_sum(lane, vec4<f32>(push, 0.0));
    let held = control_sum(lane, vec4<f32>(drawn, 0.0));
    if (is_row && lane % CONTROL_THREADS == 0u) {
        control_force[row] = pushed;
        control_solved[row] = held;
    }
}
