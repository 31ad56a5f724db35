// Last pass of `tets::mobility`: the diagonal of the pressure solve; `mobility.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_corners: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_pushed: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_compliance: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;

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
    var follows = 0.0;
    var direct = 0.0;
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        let response = control_compliance[corners[corner]];
        let own = fluid_shares[TET_CORNERS * row + corner];
        follows += own[CORNER_WEIGHT] * response[CONTROL_COMPLIANCE_DRAWN];
        direct += dot(own.xyz, own.xyz) * response[CONTROL_COMPLIANCE_COMPLIANCE];
    }
    let own = fluid_pushed[row][FLUID_PUSHED_MOBILITY];
    let scale = clock.step * clock.step * params.particle_mass;
    let diagonal = fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_DIAGONAL];
    fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_DIAGONAL] = (own + (1.0 - own) * follows) * diagonal + direct * scale;
}
