// First pass of `tets::mobility`: how much the drag leaves of a change of the velocity of every particle.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_corners: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_material: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_pushed: array<vec4<f32>>;

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
    var mean = vec3<f32>(0.0);
    for (var corner = 0u; corner < TET_CORNERS && corners.x != corners.y; corner += 1u) {
        mean += fluid_shares[TET_CORNERS * row + corner][CORNER_WEIGHT] * control_material[corners[corner]].xyz;
    }
    let relative = fluid_velocity[row].xyz - mean;
    let drag = fluid_drag_rate[row].xy;
    fluid_pushed[row][FLUID_PUSHED_MOBILITY] = 1.0 / (1.0 + (drag.x + drag.y * length(relative)) * clock.step);
}
