// After the pressure solve: velocity by the change of the pressure, and the pressure for the next step.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_pressure_rows: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> fluid_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_velocity: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    if (clock.running == 0u || row >= rows) {
        return;
    }
    let before = fluid_velocity[row];
    fluid_velocity[row] = with_vector(before, before.xyz + clock.step * fluid_correction[row].xyz);
    let pressure = fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_PRESSURE];
    fluid_position[row][FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY] = pressure / params.rest_density;
}
