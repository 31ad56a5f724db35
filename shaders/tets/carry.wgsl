// First pass of `tets::response`: the impulses that drag hands on to the nodes, and the velocities without drag.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_pushed: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_carried: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_undragged: array<vec4<f32>>;

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
    let moved = fluid_correction[row];
    let held = params.particle_mass * (1.0 - fluid_pushed[row][FLUID_PUSHED_MOBILITY]);
    let pressure = params.particle_mass * fluid_predicted[row][FLUID_PREDICTED_PRESSURE];
    fluid_carried[row] = vec4<f32>(held * (moved.xyz - fluid_velocity[row].xyz), pressure);
    fluid_undragged[row] = moved;
}
