// Before the implicit viscosity: the velocities by the pressure of the last step, and what it changes.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_correction: array<vec4<f32>>;

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
    let own = fluid_velocity[row];
    let pushed = fluid_correction[row];
    fluid_correction[row] = with_vector(pushed, pushed.xyz - own.xyz);
    fluid_velocity[row] = with_vector(own, pushed.xyz);
}
