// After the pressure solve: velocity by the pressure, and the pressure for the next step. Bodies receive its impulses.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_pressure_rows: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> body_pressure_wrenches: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

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
    fluid_velocity[row] = vec4<f32>(fluid_correction[row].xyz, fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_PRESSURE]);
    let groups_of_rows = (params.fluid_rows + GROUP_THREADS - 1u) / GROUP_THREADS;
    let end = groups_of_rows * params.body_rows * WRENCH_ROWS;
    for (var slot = row; slot < end; slot += params.fluid_rows) {
        body_fluid_wrenches[slot] += body_pressure_wrenches[slot];
    }
}
