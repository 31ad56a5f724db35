// Velocities with the drag, and the material that flows past them; `velocity.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_corners: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_pushed: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_solved: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_correction: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    let corners = fluid_corners[row];
    if (corners.x == corners.y) {
        return;
    }
    var mean = vec3<f32>(0.0);
    var rate = 0.0;
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        let node = control_solved[corners[corner]].xyz;
        let own = fluid_shares[TET_CORNERS * row + corner];
        mean += own[CORNER_WEIGHT] * node;
        rate -= dot(node, own.xyz);
    }
    let pushed = fluid_pushed[row];
    let velocity = pushed[FLUID_PUSHED_MOBILITY] * fluid_correction[row].xyz + (1.0 - pushed[FLUID_PUSHED_MOBILITY]) * mean;
    fluid_correction[row] = vec4<f32>(velocity, rate + dot(velocity, pushed.xyz));
}
