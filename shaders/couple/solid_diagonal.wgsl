// The diagonal of the pressure solve in sponges; `solid_diagonal.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_mobility: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;

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
    let along = fluid_renormalisation[row].xyz;
    let between = fluid_renormalisation_between[row].xyz;
    let mobility = fluid_mobility[row];
    let of_nodes = mobility[FLUID_MOBILITY_DIAGONAL] * (dot(along, along) + 2.0 * dot(between, between));
    let diagonal = fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_DIAGONAL];
    let all = mobility[FLUID_MOBILITY_WITH_NODES] * diagonal + (clock.step * clock.step) * of_nodes;
    fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_DIAGONAL] = all;
}
