// #include control_group, corner_list
// Second pass of `tets::mobility`: the mass of the water that the drag moves with every node.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_pushed: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_corners: array<u32>;
@group(0) @binding(5) var<storage, read_write> control_compliance: array<vec4<f32>>;

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
    var part = 0.0;
    for (var k = list.x + lane % CONTROL_THREADS; k < list.y; k += CONTROL_THREADS) {
        let place = control_corners[k];
        part += fluid_shares[place][CORNER_WEIGHT] * (1.0 - fluid_pushed[place / TET_CORNERS][FLUID_PUSHED_MOBILITY]);
    }
    let sum = control_sum(lane, vec4<f32>(part * params.particle_mass, 0.0, 0.0, 0.0));
    if (is_row && lane % CONTROL_THREADS == 0u) {
        control_compliance[row] = sum;
    }
}
