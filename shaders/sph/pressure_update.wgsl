// #include pressure_rows
// One round of a pressure solve: a step along the projected gradient.
//
//     P_i <- min(max(0, P_i + alpha r_i / M_i), (10 u)^2)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_pressure_solve: Solve;
@group(0) @binding(4) var<storage, read_write> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;

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
    let own = pressure_row(fluid_pressure_rows[row]);
    let next = next_pressure(own, fluid_pressure_solve.length, params.correction_speed);
    fluid_pressure_rows[row] = with_pressure(own, next);
    let before = params.rest_density * fluid_position[row][FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY];
    fluid_predicted[row][FLUID_PREDICTED_PRESSURE_CHANGE] = next - before;
}
