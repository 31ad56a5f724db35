// #include sums, shares, pressure_rows
// After the rate of the velocities: the remaining compression, and the sums for `solve_round.wgsl`.
//
//     r_i = h t_i - h div w_i

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_rate: array<f32>;
@group(0) @binding(5) var<storage, read> fluid_pressure_solve: Solve;
@group(0) @binding(6) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> solve_sums: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_moment: array<vec4<f32>>;

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
    var others = vec4<f32>(0.0);
    if (share.writes) {
        let is_in_pores = fluid_moment[row][FLUID_MOMENT_MATERIAL] > MINIMUM_MATERIAL;
        let scale = select(fluid_pressure_solve.target_scale, 1.0, is_in_pores);
        let rest = fluid_factors[row][FLUID_FACTORS_TARGET] * scale + fluid_rate[row] * clock.step;
        let left = select(rest, 0.0, fluid_renormalisation[row][FLUID_RENORMALISATION_DENSITY] < SPARSE);
        let before = pressure_row(fluid_pressure_rows[row]);
        sums = round_sums(before, left);
        let error = sums.x;
        let weighted = before.pressure * select(1.0, PRESSURE_IN_PORES, is_in_pores);
        others = vec4<f32>(weighted * weighted, error * error * (error * error), 0.0, 0.0);
        fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_COMPRESSION] = left;
    }
    let all = group_row(lane, sums, false);
    let rest = group_row(lane, others, false);
    let place = group_of(group, groups);
    if (lane == 0u && place * (GROUP / SHARES) < rows) {
        solve_sums[place * SOLVE_SUM_ROWS] = all;
        solve_sums[place * SOLVE_SUM_ROWS + 1u] = rest;
    }
}
