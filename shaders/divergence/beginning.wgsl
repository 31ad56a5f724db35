// #include sums, shares
// Third pass of `divergence::moments`: the pressure to begin with.
// Sums of the squared speeds, and outside of pores of the squared pressures and of the targets. Also the number of particles at a free
// surface. All are for `begin_solve.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> solve_sums: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_moment: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let row = share.row;
    var sums = vec4<f32>(0.0);
    if (share.writes) {
        let own = fluid_velocity[row];
        let pressure = own[FLUID_VELOCITY_PRESSURE];
        let outside = vec2<f32>(pressure * pressure, fluid_factors[row][FLUID_FACTORS_TARGET]);
        let counted = select(outside, vec2<f32>(0.0), fluid_moment[row][FLUID_MOMENT_MATERIAL] > MINIMUM_MATERIAL);
        let is_dense = fluid_renormalisation[row][FLUID_RENORMALISATION_DENSITY] >= SPARSE;
        let moment = fluid_moment[row].xyz;
        let open = SURFACE_OPEN * params.surface_moment;
        let is_open = !is_dense || dot(moment, moment) > open * open;
        sums = vec4<f32>(dot(own.xyz, own.xyz), counted, select(0.0, 1.0, is_open));
        fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_PRESSURE] = select(0.0, pressure, is_dense);
    }
    let all = group_row(lane, sums, false);
    let place = group_of(group, groups);
    if (lane == 0u && place * (GROUP / SHARES) < rows) {
        solve_sums[place * SOLVE_SUM_ROWS] = all;
    }
}
